#pragma once
// The lock-step barrier without sockets: messages of peers in, messages to peers out. Who may say
// what and when is decided here, by the table in docs/protocol.md.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "network/selection.h"
#include "network/server.h"
#include "network/session.h"
#include "wire/inbox.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "world/state.h"

namespace ziggurat::network {

enum class Delivery {
  sent,
  unreachable,  ///< the peer's connection is gone
  congested,    ///< the peer does not read; the message was dropped
};

/// Sends a message to the peer with this routing id, without waiting.
using Send = std::function<Delivery(const std::string& peer, const wire::Outbox& message)>;

/// The text with control characters replaced, so that a line stays a line on any terminal.
std::string printable(std::string_view text);

class Barrier {
 public:
  /// What the run refers to must outlive the barrier.
  Barrier(const Config& config, const wire::Run& run, Send send);
  Barrier(const Barrier&) = delete;
  Barrier& operator=(const Barrier&) = delete;

  /// One message of a peer.
  /// @param commands  where values go while a tick is being collected; null otherwise
  void receive(const std::string& peer, std::string_view bytes, world::Commands* commands);
  /// A message that is no message of the protocol: of several frames, say.
  void receive_malformed(const std::string& peer);

  /// @param tag_payloads  of the same tick, for each of Layout::tags
  void publish(const world::Observations& observations, std::span<const std::string> tag_payloads);
  void finish(const wire::End& end);
  void remove_robots(std::span<const std::size_t> robots);
  /// Sends every session a heartbeat, to notice those whose connection is gone.
  void probe();
  /// Zeroes the targets of robots that are gone.
  void zero_gone(world::Commands& commands) const;

  bool gathered() const { return free_ == 0; }                 ///< every robot is held or gone
  bool complete() const { return free_ == 0 && owing_ == 0; }  ///< and has answered
  bool drained() const;                                        ///< nobody is left

  std::vector<RobotStatus> status() const;
  Report take_report();

 private:
  struct Seat {  // of a robot
    Session* holder = nullptr;
    bool gone = false;
    std::chrono::steady_clock::time_point free_since = std::chrono::steady_clock::now();
  };

  // barrier.cpp
  wire::Encoding encoding_of(const std::string& peer) const;
  void say_malformed(const std::string& peer, Session* session, std::string_view why);
  void fail(const std::string& peer, Session* session, wire::Fault fault,
            std::optional<std::uint64_t> request = {});
  void say_leave(Session& session);
  void say_heartbeat(const std::string& peer);
  void mark_gone(Session* session, std::size_t robot);
  void settle(Session& session);
  void lose(Session& session, std::string_view why);
  void erase(Session& session);
  void note(std::string text);
  std::string robots_of(const Session& session) const;

  // barrier_command.cpp
  bool observe(Session& session);
  void say_command(Session& session, world::Commands* commands);
  std::optional<wire::Fault> check_tick(const Session& session) const;

  // barrier_hello.cpp
  void say_hello(const std::string& peer);
  std::optional<wire::Refusal> check_hello(const wire::Hello& hello) const;
  std::optional<wire::Refusal> check_seat(std::size_t robot);
  std::variant<Session*, wire::Refusal> take_robots(const wire::Hello& hello);
  std::variant<Session*, wire::Refusal> resume(const wire::Hello& hello);
  bool is_reachable(Session& session);
  void refuse(const std::string& peer, const wire::Hello& hello, wire::Refusal refused);

  Config config_;
  wire::Run run_;
  std::function<Delivery(const std::string& peer, wire::Outbox& message)> send_;  // in its form
  wire::Inbox inbox_;
  wire::Outbox outbox_;  // everything but observations
  wire::Encoding stranger_ = wire::Encoding::binary;  // of the last peer without session
  std::vector<std::unique_ptr<Session>> sessions_;
  std::unordered_map<std::string, Session*> by_peer_;  // looked up, never walked
  std::vector<Seat> seats_;                            // per robot of the layout
  std::size_t free_ = 0;                               // robots that nobody holds
  std::size_t owing_ = 0;                              // sessions that owe an answer
  std::optional<world::Observations> observations_;    // of the published tick
  std::vector<std::string> tag_payloads_;              // at the published tick
  bool finished_ = false;
  std::uint64_t heartbeats_ = 0;
  Report report_;
};

}  // namespace ziggurat::network
