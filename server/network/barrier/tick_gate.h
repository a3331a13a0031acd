// SPDX-License-Identifier: MIT
#pragma once
// Whether the current tick is complete: every session has answered, and no robot is waited for.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "network/barrier/ownership.h"
#include "network/barrier/pending_answer.h"
#include "wire/messages.h"

namespace ziggurat::network {

class TickGate {
 public:
  /// @param robots, directors  must outlive the gate
  TickGate(const Ownership& robots, const Ownership& directors)
      : robots_(robots), directors_(directors) {}

  /// A tick begins: it is published to all sessions.
  void begin(std::uint64_t tick);
  /// Ends the current tick: the world is about to begin anew.
  void clear() { tick_.reset(); }
  /// The current tick; none before the first one.
  std::optional<std::uint64_t> tick() const { return tick_; }

  /// The session is_owed an answer to the current tick, which it is sent now.
  void await(PendingAnswer& answer, Time now);
  /// It is_owed nothing any more. No effect if it does not owe.
  void settle(PendingAnswer& answer, Time now);
  /// It is_owed nothing any more because its deadline has passed: the tick goes on without it.
  void miss(PendingAnswer& answer, Time now);
  /// It is_owed nothing any more because the world is put back.
  void give_up(PendingAnswer& answer, Time now);
  /// Time that the current tick waits, or waited, for this answer.
  std::chrono::nanoseconds waited(const PendingAnswer& answer, Time now) const;
  /// The tick has gone on without an answer for this session.
  bool has_missed(const PendingAnswer& answer) const {
    return answer.has_missed && answer.tick == tick_;
  }

  enum class Hold { paused, stopped, finished };
  /// No tick is complete while the world is paused or stopped (by a deadline). While there is any
  /// hold, no deadline runs; a pause keeps deadlines only from when the world is halted.
  void hold(Hold why) { holds_[static_cast<std::size_t>(why)] = true; }
  void release(Hold why) { holds_[static_cast<std::size_t>(why)] = false; }
  bool is_held(Hold why) const { return holds_[static_cast<std::size_t>(why)]; }

  /// Halts the world, or not: it is paused, and the tick is answered.
  void set_halted(bool is_halted) { is_halted_ = is_halted; }
  bool is_halted() const { return is_halted_; }

  /// A session is_owed an answer.
  bool is_owed() const { return owing_ > 0; }
  /// No session is_owed an answer, and no free robot or director is waited for.
  bool is_answered() const {
    return !is_owed() && !robots_.is_awaited() && !directors_.is_awaited();
  }
  bool is_complete() const {
    return is_answered() && !is_held(Hold::paused) && !is_held(Hold::stopped);
  }

 private:
  const Ownership& robots_;
  const Ownership& directors_;
  std::optional<std::uint64_t> tick_;
  std::size_t owing_ = 0;  // sessions that owe an answer
  bool holds_[3] = {};     // by Hold
  bool is_halted_ = false;
};

/// Why an answer that can't be taken is no bad message.
enum class StaleReason {
  none,
  missed_deadline,  ///< its session was told already that it was too late
  world_restarted,  ///< it was on its way when the world was put back
};
/// Each answer has an excuse once. @param code  of its fault
StaleReason take_stale_reason(PendingAnswer& answer, wire::ErrorCode code);

/// Why a Command of an epoch does not answer the last observation of a session, if it does not.
/// @param epoch  none: the Command does not say
std::optional<wire::Fault> check_epoch(const PendingAnswer& answer,
                                       std::optional<std::uint64_t> epoch);
/// Why a Command for a tick does not answer the last observation of a session, if it does not.
/// @param answer  of a session that has had an observation
std::optional<wire::Fault> check_tick(const PendingAnswer& answer, std::uint64_t tick);

}  // namespace ziggurat::network
