#pragma once
// What the server knows of one client.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/delays.h"
#include "network/latencies.h"
#include "wire/outbox.h"
#include "wire/roster.h"

namespace ziggurat::network {

using Clock = std::chrono::steady_clock;

/// States of the protocol's state machine (docs/protocol.md) that last. NEW and CLOSED have no
/// session; HELLO is before there is a barrier.
enum class SessionState {
  ready,     ///< welcomed; no tick yet
  stepping,  ///< gets observations
  paused,    ///< was told that no tick comes for now
  draining,  ///< was told the end
  lost,      ///< its connection is gone; its robots are free
};

struct Session {
  std::string peer;                                  ///< routing id of its connection
  std::string token;                                 ///< to resume with
  std::string client;                                ///< name and version, for messages
  std::uint32_t minor = 0;                           ///< of the protocol, as agreed
  wire::Encoding encoding = wire::Encoding::binary;  ///< of its messages, both ways
  wire::Role role = wire::Role::controller;
  wire::Roster roster;  ///< of other roles: empty
  SessionState state = SessionState::ready;
  bool owes = false;           ///< its observation is not answered yet
  bool has_missed = false;     ///< and will not be: the tick goes on without it
  bool is_repeated = false;    ///< its observation was sent before, to it or another
  std::uint64_t tick = 0;      ///< of its last observation
  unsigned faults = 0;         ///< bad messages since the last good one
  unsigned late_commands = 0;  ///< for ticks that it missed, that may still arrive
  unsigned heartbeats = 0;     ///< sent to it since it was last heard of
  std::optional<std::chrono::milliseconds> patience;  ///< its deadline; none: it is waited for
  Clock::time_point owes_since;
  Clock::time_point last_message;  ///< from it
  Clock::time_point last_sent;     ///< to it
  Clock::time_point lease_end;     ///< lost: until then nobody else gets its robots
  std::size_t unanswered = 0;      ///< its requests
  std::uint64_t misses = 0;        ///< deadlines
  Latencies latencies;             ///< from observation to command
  wire::Outbox observation;        ///< long-lived, for the tick path

  /// A controller of its robots whose messages are disturbed.
  struct Path {
    std::size_t controller = 0;
    std::string name;  ///< of the controller and its first robot here, for draw_fate()
  };
  std::vector<Path> paths;  ///< usually none
  DelayLine<wire::Outbox> outgoing;
  DelayLine<std::string> incoming;
  std::size_t incoming_bytes = 0;  ///< of all that are held back
};

}  // namespace ziggurat::network
