// SPDX-License-Identifier: MIT
#pragma once
// A client of a server on this machine that sends what the test says.

#include <gtest/gtest.h>

#include <string>
#include <vector>
#include <zmq.hpp>

#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {

class Peer {
 public:
  explicit Peer(const std::vector<std::string>& endpoints) : dealer_(context_, ZMQ_DEALER) {
    dealer_.set(zmq::sockopt::linger, 0);
    dealer_.set(zmq::sockopt::rcvtimeo, 5000);
    dealer_.connect(endpoints.front());
  }
  void say(const v1::ClientMessage& message) { say(message.SerializeAsString()); }
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
  std::string last;

 private:
  zmq::context_t context_;
  zmq::socket_t dealer_;
};

}  // namespace ziggurat::network
