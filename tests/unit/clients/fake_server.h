// SPDX-License-Identifier: MIT
#pragma once
// A server whose messages the test chooses.

#include <gtest/gtest.h>
#include <zmq.h>

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "waiting.h"
#include "words_of.h"
#include "ziggurat/error.h"
#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Runs `script` in a thread beside the test.
class FakeServer {
 public:
  explicit FakeServer(std::function<void(FakeServer&)> script) : context_(zmq_ctx_new()) {
    listen("tcp://127.0.0.1:*");
    std::array<char, 100> address{};
    std::size_t size = address.size();
    zmq_getsockopt(router_, ZMQ_LAST_ENDPOINT, address.data(), &size);
    endpoint = address.data();
    thread_ = std::thread([this, script] {
      script(*this);
      stop_listening();
    });
  }
  ~FakeServer() {
    thread_.join();
    zmq_ctx_term(context_);
  }

  /// Closes all connections.
  void stop_listening() {
    if (router_ != nullptr) zmq_close(std::exchange(router_, nullptr));
  }
  void cut() {
    stop_listening();
    listen(endpoint);
  }

  /// The client's next message; empty if none comes.
  v1::ClientMessage receive() {
    std::array<char, 64> peer{};
    const int size = zmq_recv(router_, peer.data(), peer.size(), 0);
    if (size < 0) return {};
    peer_.assign(peer.data(), static_cast<std::size_t>(size));
    zmq_msg_t frame;
    zmq_msg_init(&frame);
    zmq_msg_recv(&frame, router_, 0);
    v1::ClientMessage message;
    EXPECT_TRUE(
        message.ParseFromArray(zmq_msg_data(&frame), static_cast<int>(zmq_msg_size(&frame))));
    zmq_msg_close(&frame);
    return message;
  }
  void send(const v1::ServerMessage& message) { send_bytes(message.SerializeAsString()); }
  void send_bytes(const std::string& bytes) {
    zmq_send(router_, peer_.data(), peer_.size(), ZMQ_SNDMORE);
    zmq_send(router_, bytes.data(), bytes.size(), 0);
  }

  /// Answers Hello with this message.
  void welcome(const v1::ServerMessage& message) {
    EXPECT_TRUE(receive().has_hello());
    send(message);
  }

  /// Two robots "a" and "b", each with joint "slide" (encoder) and "hinge" (encoder and motor).
  static v1::ServerMessage two_robots() {
    v1::ServerMessage message;
    v1::Welcome& welcome = *message.mutable_welcome();
    welcome.mutable_version()->set_major(1);
    welcome.set_seed(7);
    welcome.set_tick_ns(50'000'000);
    welcome.set_max_message_bytes(1 << 20);
    welcome.set_session_token("token");
    for (const char* id : {"a", "b"}) {
      v1::RobotDescription& robot = *welcome.add_robots();
      robot.set_id(id);
      auto& param = *robot.add_params();
      param.set_name("speed");
      param.set_value("3");
      robot.add_joint_sensors()->set_id("slide");
      auto& sensor = *robot.add_joint_sensors();
      sensor.set_id("hinge");
      sensor.set_mode(v1::JointDescription::POSITION);
      auto& actuator = *robot.add_joint_actuators();
      actuator.set_id("hinge");
      actuator.set_mode(v1::JointDescription::VELOCITY);
      actuator.set_max_impulse(0.5);
    }
    return message;
  }
  void welcome() { welcome(two_robots()); }
  void observe(std::uint64_t tick, std::vector<double> readings) {
    v1::ServerMessage message;
    message.mutable_observation()->set_tick(tick);
    message.mutable_observation()->set_time_ns(static_cast<std::int64_t>(tick) * 50'000'000);
    message.mutable_observation()->mutable_joint_readings()->Add(readings.begin(), readings.end());
    send(message);
  }
  void end() {
    v1::ServerMessage message;
    message.mutable_end()->set_reason(v1::End::FINISHED);
    send(message);
  }
  /// The end, and the client's Leave.
  void finish() {
    end();
    receive();
  }
  /// A reset to seed 8.
  void reset() {
    v1::ServerMessage message;
    message.mutable_reset()->set_seed(8);
    send(message);
  }
  /// The client's last message was wrong.
  void discard(v1::Error::Code code) {
    v1::ServerMessage message;
    message.mutable_error()->set_code(code);
    message.mutable_error()->set_severity(v1::Error::DISCARD);
    send(message);
  }

  std::string endpoint;

 private:
  void listen(const std::string& address) {
    constexpr int patience_ms = 60'000;  // also on a busy machine
    constexpr int linger_ms = 10'000;    // a busy machine may take seconds for what is large
    router_ = zmq_socket(context_, ZMQ_ROUTER);
    zmq_setsockopt(router_, ZMQ_RCVTIMEO, &patience_ms, sizeof(patience_ms));
    zmq_setsockopt(router_, ZMQ_LINGER, &linger_ms, sizeof(linger_ms));
    // The port is free when the connections before are closed.
    EXPECT_TRUE(comes_true([&] { return zmq_bind(router_, address.c_str()) == 0; }));
  }

  void* context_;
  void* router_ = nullptr;
  std::string peer_;
  std::thread thread_;
};

inline Options options_for(const FakeServer& server) {
  Options options;
  options.endpoint = server.endpoint;
  options.connect_timeout = std::chrono::milliseconds{20'000};
  options.wait_timeout = std::chrono::milliseconds{20'000};
  return options;
}

/// A client that is welcomed so does not take this message, and says these words. `look` sees its
/// session after that.
inline void expect_refused(const v1::ServerMessage& welcome, const v1::ServerMessage& message,
                           const char* words, const std::function<void(Session&)>& look = {}) {
  FakeServer server([&](FakeServer& self) {
    self.welcome(welcome);
    self.send(message);
    self.receive();
  });
  Session session(options_for(server));
  EXPECT_TRUE(fails_with<ConnectionError>(words, [&] { session.next(); }));
  if (look) look(session);
}

}  // namespace ziggurat
