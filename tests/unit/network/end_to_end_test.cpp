// SPDX-License-Identifier: MIT
// Real sockets, real clients in threads: the barrier as a run sees it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "network/local_server.h"
#include "network/small_run.h"
#include "words_of.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

Options options_for(const Server& server, std::vector<std::string> robots) {
  Options options;
  options.endpoint = server.endpoints().front();
  options.robots = std::move(robots);
  options.name = "test";
  options.wait_timeout = milliseconds{20'000};
  return options;
}

/// Ticks 0 … `last`, each reading of robot i being 100 * tick + i.
void serve(Server& server, const SmallRun& small, std::uint64_t last, world::Commands& commands) {
  ASSERT_EQ(server.gather(patience), Outcome::complete);
  for (std::uint64_t tick = 0; tick <= last; ++tick) {
    const world::Observations seen = small.observations(tick);
    server.publish(seen, no_tags);
    ASSERT_EQ(server.collect(commands, patience), Outcome::complete);
  }
  server.finish({wire::EndReason::finished, "", last});
  EXPECT_EQ(server.drain(patience), Outcome::complete);
}

TEST(EndToEnd, AnswersReachTheWorldAndReadingsTheClients) {
  const SmallRun small(3);
  Server server(local_config(), small.run());
  const auto drive = [&](std::vector<std::string> robots) {
    ziggurat::Session session(options_for(server, std::move(robots)));
    std::uint64_t expected = 0;
    while (session.next()) {
      EXPECT_EQ(session.event(), expected == 0 ? Event::init : Event::step);
      EXPECT_EQ(session.tick(), expected++);
      for (Robot& robot : session.robots()) {
        Joint& joint = robot.joint("hinge");
        joint.set_target(joint.encoder() + 0.5);
      }
    }
    EXPECT_EQ(expected, 21U);
    ASSERT_TRUE(session.ending());
    EXPECT_EQ(session.ending()->reason, Ending::Reason::finished);
    EXPECT_EQ(session.ending()->tick, 20U);
  };
  std::thread first(drive, std::vector<std::string>{"robot0", "robot2"});
  std::thread second(drive, std::vector<std::string>{"robot1"});
  world::Commands commands = small.commands();
  serve(server, small, 20, commands);
  first.join();
  second.join();
  EXPECT_EQ(commands.joint_targets, (std::vector<double>{2000.5, 2001.5, 2002.5}));
}

TEST(EndToEnd, AReadableDescriptorWakesTheWait) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::array<int, 1> descriptors{ends[0]};
  EXPECT_EQ(server.gather({milliseconds{10}, descriptors}), Outcome::timed_out);
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_EQ(server.gather({milliseconds{20'000}, descriptors}), Outcome::woken);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(EndToEnd, IpcAndTcpAtOnce) {
  const SmallRun small(2);
  Config config = local_config();
  config.endpoints.push_back("ipc://@ziggurat-test-" + std::to_string(::getpid()));
  Server server(config, small.run());
  ASSERT_EQ(server.endpoints().size(), 2U);
  const auto drive = [&](std::size_t endpoint) {
    Options options = options_for(server, {"robot" + std::to_string(endpoint)});
    options.endpoint = server.endpoints()[endpoint];
    ziggurat::Session session(options);
    while (session.next()) {
    }
  };
  std::thread tcp(drive, 0);
  std::thread ipc(drive, 1);
  world::Commands commands = small.commands();
  serve(server, small, 3, commands);
  tcp.join();
  ipc.join();
}

TEST(EndToEnd, APortThatIsTakenIsOneClearError) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  Config config;
  config.endpoints = {server.endpoints().front()};
  EXPECT_TRUE(
      fails_with<EndpointError>("taken", [&] { const Server second(config, small.run()); }));
}

}  // namespace
}  // namespace ziggurat::network
