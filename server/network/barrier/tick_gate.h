#pragma once
// Whether the tick in hand is complete: every session has answered, and no robot is waited for.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "network/barrier/seats.h"
#include "network/barrier/turn.h"
#include "wire/messages.h"

namespace ziggurat::network {

class TickGate {
 public:
  /// @param seats, directors  must outlive the gate
  TickGate(const Seats& seats, const Seats& directors) : seats_(seats), directors_(directors) {}

  /// A tick begins: it is published to all sessions.
  void begin(std::uint64_t tick);
  /// There is no tick in hand: the world is about to begin anew.
  void clear() { tick_.reset(); }
  /// The tick in hand; none before the first one.
  std::optional<std::uint64_t> tick() const { return tick_; }

  /// The session of this turn owes an answer to the tick in hand, which it is sent now.
  void await(Turn& turn, Time now);
  /// It owes nothing any more. No effect if it does not owe.
  void settle(Turn& turn, Time now);
  /// It owes nothing any more because its deadline has passed: the tick goes on without it.
  void miss(Turn& turn, Time now);
  /// It owes nothing any more because the world is put back.
  void give_up(Turn& turn, Time now);
  /// How long the tick in hand waits, or waited, for this answer.
  std::chrono::nanoseconds waited(const Turn& turn, Time now) const;
  /// The tick has gone on without an answer for this session.
  bool has_missed(const Turn& turn) const { return turn.has_missed && turn.tick == tick_; }

  enum class Hold { paused, stopped, finished };
  /// No tick is complete while the world is paused or stopped (by a deadline). While there is any
  /// hold, no deadline runs; a pause keeps deadlines only from when the world stands.
  void hold(Hold why) { holds_[static_cast<std::size_t>(why)] = true; }
  void release(Hold why) { holds_[static_cast<std::size_t>(why)] = false; }
  bool is_held(Hold why) const { return holds_[static_cast<std::size_t>(why)]; }

  /// The world stands, or does not: it is paused, and the tick is answered.
  void set_standing(bool is_standing) { is_standing_ = is_standing; }
  bool is_standing() const { return is_standing_; }

  /// A session owes an answer.
  bool is_owed() const { return owing_ > 0; }
  /// No session owes an answer, and no free robot or director is waited for.
  bool is_answered() const {
    return !is_owed() && !seats_.is_awaited() && !directors_.is_awaited();
  }
  bool is_complete() const {
    return is_answered() && !is_held(Hold::paused) && !is_held(Hold::stopped);
  }

 private:
  const Seats& seats_;
  const Seats& directors_;
  std::optional<std::uint64_t> tick_;
  std::size_t owing_ = 0;  // sessions that owe an answer
  bool holds_[3] = {};     // by Hold
  bool is_standing_ = false;
};

/// Why an answer that can't be taken is no bad message.
enum class Excuse {
  none,
  missed,   ///< its session was told already that it was too late
  crossed,  ///< it was on its way when the world was put back
};
/// Each answer has an excuse once. @param code  of its fault
Excuse excuse_of(Turn& turn, wire::ErrorCode code);

/// Why a Command of an epoch does not answer the last observation of a session, if it does not.
/// @param epoch  none: the Command does not say
std::optional<wire::Fault> check_epoch(const Turn& turn, std::optional<std::uint64_t> epoch);
/// Why a Command for a tick does not answer the last observation of a session, if it does not.
/// @param turn  of a session that has had an observation
std::optional<wire::Fault> check_tick(const Turn& turn, std::uint64_t tick);

}  // namespace ziggurat::network
