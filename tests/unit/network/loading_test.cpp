// SPDX-License-Identifier: MIT
// Clients that come before the world is there, on real sockets.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <optional>

#include "network/local_server.h"
#include "network/one_peer.h"
#include "network/small_run.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds out_of_the_way{100'000};

Config config_with_heartbeat(milliseconds heartbeat) {
  Config config = local_config();
  config.heartbeat = heartbeat;
  return config;
}

v1::ClientMessage hello(const std::string& robots) {
  v1::ClientMessage message;
  message.mutable_hello()->mutable_version()->set_major(1);
  message.mutable_hello()->set_role(v1::ROLE_CONTROLLER);
  message.mutable_hello()->add_robots(robots);
  return message;
}

/// Lets the server answer what arrives, for a moment.
void attend(Server& server, const Progress& progress = {}) {
  server.attend(progress, {milliseconds{100}, {}});
}

TEST(Loading, ADescriptorEndsTheWait) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  Server server(config_with_heartbeat(out_of_the_way));
  ASSERT_EQ(::write(pipe[1], "x", 1), 1);
  const std::array descriptors{pipe[0]};
  EXPECT_EQ(server.attend({}, {milliseconds{5000}, descriptors}), Outcome::woken);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(Loading, AClientThatWentAwayGetsNoSession) {
  const SmallRun small(1);
  Config config = config_with_heartbeat(milliseconds{20});
  config.lease = milliseconds{60'000};
  Server server(config);
  {
    Peer peer(server.endpoints());
    peer.say(hello("*"));
    attend(server);
    EXPECT_TRUE(peer.hear().has_loading());
  }
  Peer heir(server.endpoints());
  heir.say(hello("*"));
  attend(server);
  EXPECT_TRUE(heir.hear().has_loading());
  server.open(small.run(), config);
  EXPECT_EQ(server.gather(patience), Outcome::complete);
}

TEST(Loading, ThePrivateEndpointComesWithTheWorldAndFirst) {
  const SmallRun small(1);
  Config config = config_with_heartbeat(out_of_the_way);
  Server server(config);
  const std::string endpoint = server.endpoints().at(0);
  config.private_endpoint = "ipc://@ziggurat-loading-" + std::to_string(::getpid());
  server.open(small.run(), config);
  ASSERT_EQ(server.endpoints().size(), 2U);
  EXPECT_EQ(server.endpoints()[0], config.private_endpoint);
  EXPECT_EQ(server.endpoints()[1], endpoint);
}

}  // namespace
}  // namespace ziggurat::network
