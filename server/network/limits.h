// SPDX-License-Identifier: MIT
#pragma once
// Limits for the server's memory and time that connections use (docs/protocol.md, K5).

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace ziggurat::network {

/// Standing of a connection at the server.
enum class Standing {
  none,        ///< without session
  waiting,     ///< its Hello waits for the world
  observer,    ///< with a session of that role
  supervisor,  ///< likewise
  controller,  ///< likewise, or a director: the tick path
};

/// Whether a connection ranks below controllers, directors and supervisors, which can delay a tick
/// or end the run. Any client may have such a connection.
inline bool is_other(Standing standing) {
  return standing != Standing::controller && standing != Standing::supervisor;
}

inline constexpr std::size_t kibibyte = std::size_t{1} << 10, mebibyte = std::size_t{1} << 20;

inline constexpr std::size_t longest_without_session = 64 * kibibyte;

/// Longest message that a connection of this standing may send [bytes].
/// @param most  limit of the configuration
inline std::size_t longest_message(Standing standing, std::size_t most) {
  switch (standing) {
    case Standing::none:
    case Standing::waiting:
    case Standing::observer:
      return std::min(most, longest_without_session);
    case Standing::supervisor:
      return std::min(most, 4 * mebibyte);
    case Standing::controller:
      return most;
  }
  return 0;
}

// Connections without session: how many, and how old they may become.
inline constexpr std::size_t most_without_session = 512;
inline constexpr std::chrono::seconds handshake_time{10};
inline constexpr std::chrono::seconds time_without_session{60};
/// Younger ones are not disconnected to make place.
inline constexpr std::chrono::seconds least_age{1};

/// Limit for messages that wait for a client that does not read, without its newest Observation
/// [bytes].
inline constexpr std::size_t most_waiting = 4 * mebibyte;

/// Limits for the messages of all clients together [bytes].
struct Shared {
  std::size_t unfinished = 512 * mebibyte;  ///< those that have not arrived completely
  std::size_t waiting = 256 * mebibyte;     ///< those that wait for clients, as most_waiting counts
};

/// Share of the wall time by which others may delay ticks. It counts only while an answer is owed.
/// Work for others counts in full only if a message of a controller or supervisor waits after it.
/// The system's own work for others costs about as much again on the same machine.
inline constexpr double share_of_others = 0.01;
/// The same where clients need keys. A handshake takes ten times as long there, and legitimate
/// clients queue behind unknown peers.
inline constexpr double share_of_others_with_keys = 0.025;
/// Share of its time that work is charged if no such message waits after it. Others so have a fifth
/// of the idle time of a tick, because controllers compute in it, perhaps on the same processors.
inline constexpr double part_of_idle_time = 0.05;
/// Greatest share that is saved up.
inline constexpr std::chrono::microseconds saved_share{5000};
/// Share that an exhausted account begins again with.
inline constexpr std::chrono::microseconds least_share{100};
/// Least cost of work, because it wakes a process: it delays 400 ticks a second at most.
inline constexpr std::chrono::microseconds least_cost{25};
/// Least cost of work after which no message waits: 2000 a second.
inline constexpr std::chrono::microseconds least_idle_cost{5};
/// Greatest cost of an answer of a very large world: beyond it others would wait for longer than 10
/// s.
inline constexpr std::chrono::microseconds most_cost{100'000};

}  // namespace ziggurat::network
