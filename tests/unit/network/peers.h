#pragma once
// Peers of a barrier without sockets: what they say, and what they are told.

#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "network/barrier.h"
#include "network/small_run.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {

/// The form that peers talk: JSON if ZIGGURAT_TEST_ENCODING=json is in the environment. ctest runs
/// the conformance tests in both.
inline bool talks_json() {
  const char* encoding = std::getenv("ZIGGURAT_TEST_ENCODING");
  return encoding != nullptr && encoding == std::string("json");
}

inline std::string bytes_of(const v1::ClientMessage& message, bool json) {
  return json ? v1::to_json(message) : message.SerializeAsString();
}

/// Told apart by the first byte, as a client may.
inline v1::ServerMessage message_of(const std::string& bytes) {
  v1::ServerMessage message;
  const bool is_right = bytes.starts_with('{') ? v1::from_json(bytes, message).empty()
                                               : message.ParseFromString(bytes);
  if (!is_right) throw std::logic_error("not a ServerMessage: " + bytes);
  return message;
}

class Peers {
 public:
  explicit Peers(const SmallRun& small, const Config& config = {})
      : small_(small),
        commands(small.commands()),
        barrier(
            config, small.run(),
            [this](const std::string& peer, const wire::Outbox& message) {
              if (unreachable.contains(peer)) return Delivery::unreachable;
              if (congested.contains(peer)) return Delivery::congested;
              std::string bytes(message.size(), '\0');
              message.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
              inboxes[peer].push_back(message_of(bytes));
              if (bytes.starts_with('{') != json) told_otherwise.insert(peer);
              return Delivery::sent;
            },
            now) {}

  /// Wall time goes on.
  void pass(std::chrono::milliseconds time) {
    barrier.advance(now += time);
    barrier.receive_due(&commands);
  }
  /// Time enough for a heartbeat, which finds out whose connection is gone.
  void probe() { pass(std::chrono::milliseconds{1000}); }

  void say(const std::string& peer, const v1::ClientMessage& message) {
    barrier.receive(peer, bytes_of(message, json), &commands);
  }
  void say_bytes(const std::string& peer, const std::string& bytes) {
    barrier.receive(peer, bytes, &commands);
  }

  /// The one message that the peer was told since it was last asked; empty if none or several.
  v1::ServerMessage told(const std::string& peer) {
    auto messages = std::exchange(inboxes[peer], {});
    return messages.size() == 1 ? messages.front() : v1::ServerMessage{};
  }

  static v1::ClientMessage hello(const std::string& robots) {
    v1::ClientMessage message;
    v1::Hello& hello = *message.mutable_hello();
    hello.mutable_version()->set_major(1);
    hello.set_role(v1::ROLE_CONTROLLER);
    hello.set_client_name("tester");
    hello.add_robots(robots);
    return message;
  }
  static v1::ClientMessage command(std::uint64_t tick, std::vector<double> targets = {}) {
    v1::ClientMessage message;
    message.mutable_command()->set_tick(tick);
    message.mutable_command()->mutable_joint_targets()->Add(targets.begin(), targets.end());
    return message;
  }
  static v1::ClientMessage leave(std::vector<std::uint32_t> robots = {},
                                 v1::Leave::Reason reason = v1::Leave::DONE) {
    v1::ClientMessage message;
    message.mutable_leave()->mutable_robots()->Add(robots.begin(), robots.end());
    message.mutable_leave()->set_reason(reason);
    return message;
  }
  static v1::ClientMessage heartbeat(std::uint64_t sequence) {
    v1::ClientMessage message;
    message.mutable_heartbeat()->set_sequence(sequence);
    return message;
  }
  static v1::ClientMessage request(std::uint64_t id) {
    v1::ClientMessage message;
    message.mutable_request()->set_id(id);
    message.mutable_request()->mutable_status();
    return message;
  }

  /// Welcomed with these robots.
  v1::Welcome join(const std::string& peer, const std::string& robots) {
    say(peer, hello(robots));
    return told(peer).welcome();
  }
  void publish(std::uint64_t tick) { publish(small_.observations(tick)); }
  void publish(const world::Observations& seen, const std::vector<std::string>& tag_payloads = {}) {
    barrier.publish(seen, tag_payloads);
  }

 private:
  const SmallRun& small_;

 public:
  bool json = talks_json();              ///< what say() talks
  std::set<std::string> told_otherwise;  ///< peers that were told something in the other form
  std::map<std::string, std::vector<v1::ServerMessage>> inboxes;
  std::set<std::string> unreachable, congested;
  Clock::time_point now;
  world::Commands commands;
  Barrier barrier;
};

}  // namespace ziggurat::network
