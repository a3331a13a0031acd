// SPDX-License-Identifier: MIT
// Events of a client's ZeroMQ socket during a handshake (docs/protocol.md, K8). Authors of clients
// tell a refusal from slowness by them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <map>
#include <zmq.hpp>

#include "network/keys.h"
#include "network/local_server.h"
#include "network/small_run.h"
#include "temporary_folder.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

struct CurveRefusals : ::testing::Test {
  CurveRefusals() {
    server_key = write_key_pair(folder / "server");
    listed_key = write_key_pair(folder / "listed");
    other_key = write_key_pair(folder / "other");
    config.endpoints = {"tcp://127.0.0.1:*"};
    config.curve = {secret("server"), {}};
    config.curve->clients.push_back({listed_key, {.controller = true}, ""});
  }
  std::string secret(const std::string& name) const {
    return read_secret_key(folder / (name + ".secret"));
  }

  /// The first event of the handshake that a client reports, and its value.
  /// @param server_is  public key; empty: without CURVE
  std::pair<int, std::uint32_t> outcome(Server& server, const std::string& server_is,
                                        const std::string& name) {
    zmq::context_t context;
    zmq::socket_t dealer(context, zmq::socket_type::dealer);
    zmq::socket_t monitor(context, zmq::socket_type::pair);
    dealer.set(zmq::sockopt::linger, 0);
    monitor.set(zmq::sockopt::linger, 0);
    monitor.set(zmq::sockopt::rcvtimeo, 0);
    zmq_socket_monitor(dealer.handle(), "inproc://events",
                       ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH |
                           ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                           ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL);
    monitor.connect("inproc://events");
    if (!server_is.empty()) {
      dealer.set(zmq::sockopt::curve_serverkey, server_is);
      dealer.set(zmq::sockopt::curve_secretkey, secret(name));
      dealer.set(zmq::sockopt::curve_publickey, public_key_of(secret(name)));
    }
    dealer.connect(server.endpoints().back());
    for (int i = 0; i < 500; ++i) {
      server.gather({milliseconds{10}, {}});
      zmq::message_t event;
      if (!monitor.recv(event)) continue;
      std::uint16_t number = 0;
      std::uint32_t value = 0;
      std::memcpy(&number, event.data(), sizeof(number));
      std::memcpy(&value, event.data<char>() + sizeof(number), sizeof(value));
      return {number, value};
    }
    return {0, 0};
  }

  TemporaryFolder folder;
  std::string server_key, listed_key, other_key;
  Config config;
};

TEST_F(CurveRefusals, K8_AListedKeySucceeds) {
  const SmallRun small(1);
  Server server(config, small.run());
  EXPECT_EQ(outcome(server, server_key, "listed").first, ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
}

TEST_F(CurveRefusals, K8_AnUnlistedKeyIsRefusedWith400) {
  const SmallRun small(1);
  Server server(config, small.run());
  EXPECT_EQ(outcome(server, server_key, "other"),
            (std::pair<int, std::uint32_t>{ZMQ_EVENT_HANDSHAKE_FAILED_AUTH, 400}));
}

TEST_F(CurveRefusals, K8_AWrongServerKeyFailsWithoutDetail) {
  const SmallRun small(1);
  Server server(config, small.run());
  EXPECT_EQ(outcome(server, other_key, "listed").first, ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL);
}

TEST_F(CurveRefusals, K8_OnlyOneSideWithCurveIsAMismatch) {
  const SmallRun small(1);
  const std::pair<int, std::uint32_t> mismatch{ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL,
                                               ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH};
  Server curve(config, small.run());
  EXPECT_EQ(outcome(curve, "", ""), mismatch);
  config.curve.reset();
  Server plain(config, small.run());
  EXPECT_EQ(outcome(plain, server_key, "listed"), mismatch);
}

}  // namespace
}  // namespace ziggurat::network
