// SPDX-License-Identifier: MIT
#pragma once
// Peers of a barrier without sockets: what they send, and what they are told.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "network/barrier/admission.h"
#include "network/barrier/departure.h"
#include "network/barrier/dispatch.h"
#include "network/barrier/exchange.h"
#include "network/barrier/overview.h"
#include "network/barrier/population.h"
#include "network/barrier/timeouts.h"
#include "network/disturbed_link.h"
#include "network/small_run.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {

inline std::string bytes_of(const v1::ClientMessage& message, wire::Encoding encoding) {
  return encoding == wire::Encoding::json ? v1::to_json(message) : message.SerializeAsString();
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
  enum class World { loaded, loading };
  /// @param world  loading: open() comes later
  explicit Peers(const SmallRun& small, const Config& config = {}, World world = World::loaded)
      : small_(small),
        config_(config),
        commands(small.commands()),
        barrier(
            config,
            [this](const std::string& peer, const wire::Outbox& message) {
              if (link) return link->send(peer, message, barrier.now);
              std::string bytes(message.size(), '\0');
              message.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
              return deliver(peer, bytes);
            },
            now) {
    if (!config.injections.empty()) disturb();
    if (world == World::loaded) open();
  }

  /// The world is loaded.
  void open() {
    network::open(barrier, small_.run(), config_);
    admit_waiting(barrier);
  }

  /// Wall time goes on.
  void pass(std::chrono::milliseconds time) {
    now += time;
    if (link) link->release(now);
    advance(barrier, now);
    while (const auto held = link ? link->next(now) : std::nullopt) {
      receive(barrier, *held, &commands);
    }
  }
  Time next_event() const {
    const Time next = network::next_event(barrier);
    return link ? std::min(next, link->next_event()) : next;
  }
  /// Time enough for a heartbeat, which finds out that a connection is gone.
  void probe() { pass(std::chrono::milliseconds{1000}); }

  void say(const std::string& peer, const v1::ClientMessage& message) {
    send_bytes(peer, bytes_of(message, encoding()));
  }
  void send_bytes(const std::string& peer, const std::string& bytes) {
    const Received received{.connection = peer, .bytes = bytes};
    if (!link || link->arrives(received, now)) receive(barrier, received, &commands);
  }

  wire::Encoding encoding() const { return json ? wire::Encoding::json : wire::Encoding::binary; }

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
    observations = seen;
    payloads = tag_payloads;
    network::publish(barrier, observations, payloads);
  }
  /// Robots have come at the tick that was published last.
  void add_robots(const std::string& script, const world::Observations& seen) {
    observations = seen;
    network::add_robots(barrier, {&script, 1}, {&observations, &payloads});
  }
  bool is_complete() const { return barrier.gate.is_complete(); }
  bool is_gathered() const {
    return barrier.ownership.all_taken() && barrier.directors.ownership.all_taken();
  }
  std::vector<RobotStatus> status() const { return robot_status(barrier); }
  Report take_report() { return barrier.journal.take(); }

 private:
  Delivery deliver(const std::string& peer, std::string_view bytes) {
    if (unreachable.contains(peer)) return Delivery::unreachable;
    if (congested.contains(peer)) return Delivery::congested;
    inboxes[peer].push_back(message_of(std::string(bytes)));
    if (bytes.starts_with('{') != json) told_otherwise.insert(peer);
    return Delivery::sent;
  }
  void disturb() {
    const wire::Run run = small_.run();
    std::vector<DisturbedLink::Target> targets;
    const auto add = [&](DisturbedLink::Target target) {
      target.injection = config_.injections.at(targets.size());
      targets.push_back(std::move(target));
    };
    for (const scene::Controller& controller : run.controllers) add({.id = controller.id});
    for (const scene::Director& director : run.directors)
      add({.id = director.id, .is_director = true});
    link.emplace(std::move(targets), run.seed, 2 * config_.max_message_bytes,
                 [this](const auto& peer, auto bytes, MessageKind kind) {
                   if (kind == MessageKind::observation) ++observations_sent;
                   return deliver(peer, bytes);
                 });
  }

  const SmallRun& small_;
  Config config_;

 public:
  bool json = false;                     ///< what say() talks
  std::set<std::string> told_otherwise;  ///< peers that were told something in the other form
  std::map<std::string, std::vector<v1::ServerMessage>> inboxes;
  std::set<std::string> unreachable, congested;
  int observations_sent = 0;  ///< by the link, as such
  Time now;
  world::Commands commands;
  world::Observations observations;  ///< of the published tick
  std::vector<std::string> payloads;
  std::optional<DisturbedLink> link;
  Barrier barrier;
};

}  // namespace ziggurat::network
