// SPDX-License-Identifier: MIT
#pragma once
// Ownership of robots: the session that each robot has.

#include <chrono>
#include <cstddef>
#include <vector>

#include "network/barrier/session.h"

namespace ziggurat::network {

/// Whether a session that frees a robot may have it back.
enum class Claim { kept, dropped };

/// Whether the current tick waits for a free robot.
enum class InTick { awaited, skipped };

class Ownership {
 public:
  struct Entry {
    SessionId holder = SessionId::none;    ///< drives the robot; none: the robot is free
    SessionId claimant = SessionId::none;  ///< free: the lost session that may resume
    bool has_left = false;                 ///< the barrier, for good
    bool was_held = false;                 ///< by any session, ever
    bool is_skipped = false;               ///< free, and the current tick goes on without it
    Time free_since;                       ///< free: since when
    std::chrono::nanoseconds waited{
        0};  ///< for it by the current tick, before what it waits for now

    /// The session that has the robot, or may resume; none: neither.
    SessionId owner() const { return holder == SessionId::none ? claimant : holder; }
  };

  /// One more robot, which is free.
  void add(Time now, InTick in_tick);
  /// Forgets robots behind the first `count`, which must have left.
  void shrink(std::size_t count) { entries_.resize(count); }

  const Entry& operator[](std::size_t robot) const { return entries_[robot]; }
  std::size_t size() const { return entries_.size(); }

  /// @param robot  free, and has not left
  void take(std::size_t robot, SessionId session, Time now);
  /// @param robot     held
  /// @param claimant  the lost session that may resume; none: no session
  /// @param since     when it became free, as far as its deadline is concerned
  /// @param in_tick   skipped: its session has missed the current tick already
  /// @param waited    by the current tick for its session
  void release(std::size_t robot, SessionId claimant, Time since, InTick in_tick,
               std::chrono::nanoseconds waited);
  void drop_claim(std::size_t robot) { entries_[robot].claimant = SessionId::none; }
  /// Takes the robot out of the barrier for good. No effect if it has left.
  void leave(std::size_t robot);
  /// The current tick goes on without the robot, which is free.
  void skip(std::size_t robot, Time now);
  /// A tick begins, and waits for all free robots again.
  void begin_tick(Time now);
  /// All free robots are free from now on, as far as their deadlines are concerned.
  void restart(Time now);

  bool all_taken() const { return free_ == 0; }          ///< each is held or has left
  bool is_awaited() const { return free_ != skipped_; }  ///< the tick waits for a free robot

 private:
  void wait_over(Entry& entry, Time now);

  std::vector<Entry> entries_;  // per robot of the layout
  Time begun_;                  // the current tick, as far as deadlines are concerned
  bool has_changes_ = false;    // of who has which robot, in the current tick
  std::size_t free_ = 0;        // robots without holder that have not left
  std::size_t skipped_ = 0;     // those of them that the tick does not wait for
};

}  // namespace ziggurat::network
