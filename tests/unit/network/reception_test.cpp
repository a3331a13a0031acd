// Who comes before the world is there, on real sockets.

#include "network/reception.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <optional>
#include <thread>

#include "network/small_run.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

constexpr Wait patience{milliseconds{20'000}, {}};

Config local_config(milliseconds heartbeat = milliseconds{100'000}) {
  Config config;
  config.endpoints = {"tcp://127.0.0.1:*"};
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

class Peer {
 public:
  explicit Peer(const std::vector<std::string>& endpoints) : dealer_(context_, ZMQ_DEALER) {
    dealer_.set(zmq::sockopt::linger, 0);
    dealer_.set(zmq::sockopt::rcvtimeo, 5000);
    dealer_.connect(endpoints.front());
  }
  void say(const v1::ClientMessage& message, bool json = false) {
    say(json ? v1::to_json(message) : message.SerializeAsString());
  }
  void say(const std::string& bytes) { dealer_.send(zmq::buffer(bytes)); }
  /// Empty after 5 s.
  v1::ServerMessage hear() {
    zmq::message_t frame;
    v1::ServerMessage message;
    if (!dealer_.recv(frame)) return message;
    last = frame.to_string();
    EXPECT_TRUE(last.starts_with('{') ? v1::from_json(last, message).empty()
                                      : message.ParseFromString(last));
    return message;
  }
  bool hears_nothing() {
    zmq::message_t frame;
    dealer_.set(zmq::sockopt::rcvtimeo, 50);
    return !dealer_.recv(frame);
  }
  std::string last;

 private:
  zmq::context_t context_;
  zmq::socket_t dealer_;
};

TEST(Reception, H12_LoadingAtOnceAndWelcomeWithoutAnotherHello) {
  const SmallRun small(1);
  Reception reception(local_config());
  reception.say(0.5, "half of it is there");
  Peer peer(reception.endpoints());
  peer.say(hello("*"));
  const auto loading = peer.hear();
  EXPECT_EQ(loading.loading().progress(), 0.5);
  EXPECT_EQ(loading.loading().message(), "half of it is there");
  Server server(local_config(), small.run(), reception);
  EXPECT_EQ(server.gather(patience), Outcome::complete);
  EXPECT_EQ(peer.hear().loading().progress(), 1);
  EXPECT_EQ(peer.hear().welcome().robots_size(), 1);
}

TEST(Reception, H12_AgainAboutEverySecond) {
  Reception reception(local_config(milliseconds{20}));
  Peer peer(reception.endpoints());
  peer.say(hello("*"));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(peer.hear().has_loading());
}

TEST(Reception, H12_InTheOrderOfArrival) {
  const SmallRun small(1);
  Reception reception(local_config());
  Peer first(reception.endpoints()), second(reception.endpoints());
  first.say(hello("*"));
  EXPECT_TRUE(first.hear().has_loading());
  second.say(hello("*"));
  EXPECT_TRUE(second.hear().has_loading());
  Server server(local_config(), small.run(), reception);
  EXPECT_EQ(server.gather(patience), Outcome::complete);
  EXPECT_TRUE(first.hear().has_loading());
  EXPECT_TRUE(first.hear().has_welcome());
  EXPECT_TRUE(second.hear().has_loading());
  EXPECT_EQ(second.hear().refusal().error().code(), v1::Error::ROBOT_TAKEN);
}

TEST(Reception, H12_LeaveTakesTheHelloBack) {
  const SmallRun small(1);
  Reception reception(local_config());
  Peer peer(reception.endpoints());
  peer.say(hello("*"));
  EXPECT_TRUE(peer.hear().has_loading());
  v1::ClientMessage leave;
  leave.mutable_leave()->set_reason(v1::Leave::DONE);
  peer.say(leave);
  v1::ClientMessage heartbeat;
  heartbeat.mutable_heartbeat()->set_sequence(7);
  peer.say(heartbeat);
  EXPECT_EQ(peer.hear().error().code(), v1::Error::OUT_OF_STATE) << "it is NEW again";
  Server server(local_config(), small.run(), reception);
  EXPECT_EQ(server.gather({milliseconds{50}, {}}), Outcome::timed_out);
  EXPECT_TRUE(peer.hears_nothing());
}

TEST(Reception, H12_IfThereIsNoWorldInTheEnd) {
  std::optional<Reception> reception(local_config());
  Peer peer(reception->endpoints());
  peer.say(hello("*"));
  EXPECT_TRUE(peer.hear().has_loading());
  reception.reset();
  const auto refusal = peer.hear().refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::OUT_OF_STATE);
  EXPECT_EQ(refusal.error().severity(), v1::Error::FATAL);
}

TEST(Reception, H12_NorIfItIsGivenUp) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  std::atomic<bool> is_ended = false;
  Reception reception(local_config(), {pipe[0], [&] { is_ended = true; }});
  Peer peer(reception.endpoints());
  peer.say(hello("*"));
  EXPECT_TRUE(peer.hear().has_loading());
  ASSERT_EQ(::write(pipe[1], "x", 1), 1);
  EXPECT_TRUE(peer.hear().has_refusal());
  while (!is_ended) std::this_thread::yield();
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(Reception, AnswersInTheFormOfTheHello) {
  const SmallRun small(1);
  Reception reception(local_config());
  Peer peer(reception.endpoints());
  peer.say(hello("*"), true);
  EXPECT_TRUE(peer.hear().has_loading());
  EXPECT_TRUE(peer.last.starts_with('{'));
  Server server(local_config(), small.run(), reception);
  EXPECT_EQ(server.gather(patience), Outcome::complete);
  peer.hear();
  EXPECT_TRUE(peer.hear().has_welcome());
  EXPECT_TRUE(peer.last.starts_with('{'));
}

TEST(Reception, WhatElseIsSaidMeanwhile) {
  Reception reception(local_config());
  Peer peer(reception.endpoints());
  peer.say("garbage");
  EXPECT_EQ(peer.hear().error().code(), v1::Error::MALFORMED);
  v1::ClientMessage command;
  command.mutable_command();
  peer.say(command);
  EXPECT_EQ(peer.hear().error().code(), v1::Error::OUT_OF_STATE);
  peer.say(hello("*"));
  EXPECT_TRUE(peer.hear().has_loading());
  v1::ClientMessage request;
  request.mutable_request()->mutable_status();
  for (const auto& message : {hello("*"), command, request}) {
    peer.say(message);
    const auto error = peer.hear().error();
    EXPECT_EQ(error.code(), v1::Error::OUT_OF_STATE);
    EXPECT_EQ(error.severity(), v1::Error::DISCARD);
  }
  v1::ClientMessage heartbeat;
  heartbeat.mutable_heartbeat()->set_sequence(7);
  peer.say(heartbeat);
  EXPECT_EQ(peer.hear().heartbeat().sequence(), 7U);
}

TEST(Reception, NoMoreWaitThanSessionsMay) {
  Config config = local_config();
  config.max_sessions = 1;
  Reception reception(config);
  Peer first(reception.endpoints()), second(reception.endpoints());
  first.say(hello("*"));
  EXPECT_TRUE(first.hear().has_loading());
  second.say(hello("*"));
  const auto error = second.hear().refusal().error();
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_TRUE(error.retryable());
}

TEST(Reception, WhoWentAwayGetsNoSession) {
  const SmallRun small(1);
  Config config = local_config(milliseconds{20});
  config.lease = milliseconds{60'000};
  Reception reception(config);
  {
    Peer peer(reception.endpoints());
    peer.say(hello("*"));
    EXPECT_TRUE(peer.hear().has_loading());
  }
  Peer heir(reception.endpoints());
  heir.say(hello("*"));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(heir.hear().has_loading());
  Server server(config, small.run(), reception);
  EXPECT_EQ(server.gather(patience), Outcome::complete);
}

TEST(Reception, ThePrivateEndpointComesWithTheServerAndFirst) {
  const SmallRun small(1);
  Config config = local_config();
  Reception reception(config);
  config.private_endpoint = "ipc:///tmp/ziggurat-reception-" + std::to_string(::getpid());
  const Server server(config, small.run(), reception);
  ASSERT_EQ(server.endpoints().size(), 2U);
  EXPECT_EQ(server.endpoints()[0], config.private_endpoint);
  EXPECT_EQ(server.endpoints()[1], reception.endpoints()[0]);
}

}  // namespace
}  // namespace ziggurat::network
