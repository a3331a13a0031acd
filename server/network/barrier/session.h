// SPDX-License-Identifier: MIT
#pragma once
// Session of one client, as the server knows it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "network/barrier/pending_answer.h"
#include "network/latencies.h"
#include "network/link.h"
#include "wire/command_limits.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "wire/roster.h"
#include "wire/world_view.h"

namespace ziggurat::network {

/// Names a session; no number is used twice. They ascend in the order in which sessions begin.
enum class SessionId : std::uint64_t { none = 0 };

/// States of the protocol's state machine (docs/protocol.md) that last. NEW and CLOSED have no
/// session.
enum class SessionState {
  hello,     ///< its Hello waits until the world is loaded
  ready,     ///< welcomed; no tick yet
  stepping,  ///< gets observations
  paused,    ///< was told that no tick comes for now
  draining,  ///< was told the end
  lost,      ///< its connection is gone; its robots are free
};

/// Liveness of the session's connection, and its bad messages.
struct Liveness {
  Time last_received;       ///< when a message came from it
  Time last_sent;           ///< when one was sent to it
  unsigned heartbeats = 0;  ///< sent to it since it was last heard of
  unsigned faults = 0;      ///< bad messages since the last good one
};

/// A Hello that waits for the world.
struct WaitingHello {
  std::string hello;  ///< the whole message
  Access access;      ///< of its connection
};

struct Session {
  SessionId id = SessionId::none;
  SessionState state = SessionState::ready;
  std::string connection;          ///< the one that it was made over; lost: the last one
  std::optional<std::size_t> key;  ///< that it was made with, see Access
  wire::Role role = wire::Role::controller;
  std::string client;                   ///< name and version, for messages
  std::string token;                    ///< to resume with
  std::uint32_t minor = 0;              ///< of the protocol, as agreed
  bool can_restore = false;             ///< its controllers can go back to a snapshot
  wire::Roster roster;                  ///< of other roles: empty
  std::optional<std::size_t> director;  ///< of that role: its number; none: it has left
  wire::WorldView view;                 ///< of that role: what it is told
  wire::CommandLimits command_limits;   ///< of what its robots can need, in its form
  PendingAnswer pending_answer;
  Liveness liveness;
  Latencies latencies;       ///< from observation to command
  std::uint64_t misses = 0;  ///< deadlines
  struct UnreportedMisses {
    std::uint64_t misses = 0;
    std::uint64_t first_tick = 0;
    Time until;
  } unreported;                ///< misses that no notice has reported yet
  Time lease_end;              ///< lost: until then no other session gets its robots
  wire::Outbox observation;    ///< long-lived, for the tick path
  WaitingHello waiting_hello;  ///< in HELLO

  /// It has a part in each tick.
  bool has_ticks() const { return !roster.empty() || director.has_value(); }
};

}  // namespace ziggurat::network
