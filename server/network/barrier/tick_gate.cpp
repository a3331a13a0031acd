// SPDX-License-Identifier: MIT
#include "network/barrier/tick_gate.h"

#include <fmt/format.h>

#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

void TickGate::begin(std::uint64_t tick) {
  tick_ = tick;
  is_halted_ = false;
}

void TickGate::await(PendingAnswer& answer, Time now) {
  if (!answer.is_owed) ++owing_;
  answer.tick = *tick_;
  answer.is_owed = true;
  answer.has_missed = false;
  answer.waiting_since = now;
  answer.waited = {};
}

void TickGate::settle(PendingAnswer& answer, Time now) {
  if (!answer.is_owed) return;
  answer.is_owed = false;
  answer.waited = now - answer.waiting_since;
  --owing_;
}

void TickGate::miss(PendingAnswer& answer, Time now) {
  settle(answer, now);
  answer.has_missed = true;
  ++answer.late_commands;
}

void TickGate::give_up(PendingAnswer& answer, Time now) {
  answer.stale_commands += answer.late_commands + (answer.is_owed ? 1 : 0);
  answer.late_commands = 0;
  settle(answer, now);
}

StaleReason take_stale_reason(PendingAnswer& answer, ErrorCode code) {
  const bool is_of_tick = code == ErrorCode::stale_tick || code == ErrorCode::future_tick ||
                          code == ErrorCode::duplicate_tick;
  if (is_of_tick && answer.stale_commands > 0) {
    --answer.stale_commands;
    return StaleReason::world_restarted;
  }
  if (code == ErrorCode::stale_tick && answer.late_commands > 0) {
    --answer.late_commands;
    return StaleReason::missed_deadline;
  }
  return StaleReason::none;
}

std::chrono::nanoseconds TickGate::waited(const PendingAnswer& answer, Time now) const {
  if (answer.tick != tick_) return {};
  return answer.is_owed ? now - answer.waiting_since : answer.waited;
}

std::optional<wire::Fault> check_epoch(const PendingAnswer& answer,
                                       std::optional<std::uint64_t> epoch) {
  if (!epoch || *epoch == answer.epoch) return std::nullopt;
  const bool is_past = *epoch < answer.epoch;
  return make_fault(
      is_past ? ErrorCode::stale_tick : ErrorCode::future_tick, "epoch",
      fmt::format("The Command is for a tick of epoch {}; the last Observation is of epoch "
                  "{}. Each reset and restore of the world begins another.",
                  *epoch, answer.epoch));
}

std::optional<wire::Fault> check_tick(const PendingAnswer& answer, std::uint64_t tick) {
  if (tick > answer.tick) {
    return make_fault(
        ErrorCode::future_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {}.", tick, answer.tick));
  }
  if (tick < answer.tick) {
    return make_fault(
        ErrorCode::stale_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {} already.", tick, answer.tick));
  }
  if (answer.is_owed) return std::nullopt;
  if (answer.has_missed) {
    return make_fault(ErrorCode::stale_tick, "tick",
                      fmt::format("Tick {} goes on without this Command.", tick));
  }
  return make_fault(ErrorCode::duplicate_tick, "tick",
                    fmt::format("Tick {} was answered already; the first answer counts.", tick));
}

}  // namespace ziggurat::network
