#include "network/barrier/tick_gate.h"

#include <fmt/format.h>

#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

void TickGate::begin(std::uint64_t tick) {
  tick_ = tick;
  is_standing_ = false;
}

void TickGate::await(Turn& turn, Time now) {
  if (!turn.owes) ++owing_;
  turn.tick = *tick_;
  turn.owes = true;
  turn.has_missed = false;
  turn.owes_since = now;
  turn.waited = {};
}

void TickGate::settle(Turn& turn, Time now) {
  if (!turn.owes) return;
  turn.owes = false;
  turn.waited = now - turn.owes_since;
  --owing_;
}

void TickGate::miss(Turn& turn, Time now) {
  settle(turn, now);
  turn.has_missed = true;
  ++turn.late_commands;
}

void TickGate::give_up(Turn& turn, Time now) {
  turn.crossing += turn.late_commands + (turn.owes ? 1 : 0);
  turn.late_commands = 0;
  settle(turn, now);
}

Excuse excuse_of(Turn& turn, ErrorCode code) {
  const bool is_of_tick = code == ErrorCode::stale_tick || code == ErrorCode::future_tick || code == ErrorCode::duplicate_tick;
  if (is_of_tick && turn.crossing > 0) {
    --turn.crossing;
    return Excuse::crossed;
  }
  if (code == ErrorCode::stale_tick && turn.late_commands > 0) {
    --turn.late_commands;
    return Excuse::missed;
  }
  return Excuse::none;
}

std::chrono::nanoseconds TickGate::waited(const Turn& turn, Time now) const {
  if (turn.tick != tick_) return {};
  return turn.owes ? now - turn.owes_since : turn.waited;
}

std::optional<wire::Fault> check_epoch(const Turn& turn, std::optional<std::uint64_t> epoch) {
  if (!epoch || *epoch == turn.epoch) return std::nullopt;
  const bool is_past = *epoch < turn.epoch;
  return make_fault(
      is_past ? ErrorCode::stale_tick : ErrorCode::future_tick, "epoch",
      fmt::format("The Command is for a tick of epoch {}; the last Observation is of epoch "
                  "{}. Each reset and restore of the world begins another.",
                  *epoch, turn.epoch));
}

std::optional<wire::Fault> check_tick(const Turn& turn, std::uint64_t tick) {
  if (tick > turn.tick) {
    return make_fault(
        ErrorCode::future_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {}.", tick, turn.tick));
  }
  if (tick < turn.tick) {
    return make_fault(
        ErrorCode::stale_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {} already.", tick, turn.tick));
  }
  if (turn.owes) return std::nullopt;
  if (turn.has_missed) {
    return make_fault(ErrorCode::stale_tick, "tick",
                      fmt::format("Tick {} goes on without this Command.", tick));
  }
  return make_fault(ErrorCode::duplicate_tick, "tick",
                    fmt::format("Tick {} was answered already; the first answer counts.", tick));
}

}  // namespace ziggurat::network
