// The tick path of the barrier.

#include <fmt/format.h>

#include "network/barrier.h"
#include "wire/fault.h"
#include "wire/zero.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

void Barrier::publish(const world::Observations& observations,
                      std::span<const std::string> tag_payloads) {
  observations_ = observations;
  tag_payloads_.assign(tag_payloads.begin(), tag_payloads.end());
  is_standing_ = false;
  next_deadline_ = Clock::time_point::max();
  passed_ = 0;
  if (free_ > 0) {  // the tick awaits them, or passes them again
    for (Seat& seat : seats_) seat.passed = false;
    next_deadline_ = now_;
  }
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    if (session->state == SessionState::lost || session->roster.empty()) continue;
    session->is_repeated = false;
    if (!observe(*session)) gone.push_back(session.get());
  }
  for (Session* session : gone) lose(*session, "its connection is gone, or it does not read");
}

/// Sends a session what it senses at the published tick. False if it can't be reached.
bool Barrier::observe(Session& session) {
  const std::size_t limit = session.encoding == wire::Encoding::json
                                ? wire::max_json_observation_bytes
                                : wire::max_observation_bytes;
  if (!session.observation.observation(session.roster, *observations_, tag_payloads_, limit)) {
    auto fault = make_fault(ErrorCode::too_large, {},
                            "The robots of this session heard and saw more at this tick than a "
                            "message can hold; share them among more sessions.");
    fault.severity = wire::Severity::fatal;
    fault.tick = observations_->tick;
    outbox_.error(fault);
    deliver(session, outbox_);
    return false;
  }
  session.state = SessionState::stepping;
  session.tick = observations_->tick;
  session.has_missed = false;
  if (!session.owes) ++owing_;
  session.owes = true;
  session.owes_since = now_;
  if (session.patience) next_deadline_ = std::min(next_deadline_, now_ + *session.patience);
  const Delivery delivery = send_observation(session);
  const bool may_miss = delivery == Delivery::congested && session.patience;
  return delivery == Delivery::sent || may_miss;
}

/// True if it is the answer that was due.
bool Barrier::say_command(Session& session, world::Commands* commands) {
  if (session.state == SessionState::draining) {
    // It was on its way when the end came. Its values have no effect, its last words count.
    if (!inbox_.check(session.roster, run_.layout)) {
      inbox_.append_log(session.roster, report_.log);
    }
    return false;
  }
  auto fault = check_tick(session);
  if (!fault && commands == nullptr) {
    fault = make_fault(ErrorCode::out_of_state, {}, "No tick is being collected.");
  }
  if (!fault) fault = inbox_.check(session.roster, run_.layout);
  if (fault && fault->code == ErrorCode::stale_tick && session.late_commands > 0) {
    --session.late_commands;  // as slow as it was told already, and no worse
    fault->tick = observations_->tick;
    outbox_.error(*fault);
    deliver(session, outbox_);
    return false;
  }
  if (fault) {
    fail(session.peer, &session, std::move(*fault));
    return false;
  }
  session.faults = 0;
  session.late_commands = 0;
  if (session.patience) {
    for (const std::size_t robot : session.roster.robots) seats_[robot].misses_in_row = 0;
  }
  if (session.is_repeated) wire::forget_radio_messages(session.roster, commands->radio_messages);
  inbox_.apply(session.roster, *commands);
  inbox_.append_log(session.roster, report_.log);
  settle(session);
  add_latency(session);
  return true;
}

void Barrier::add_latency(Session& session) {
  const double taken = std::chrono::duration<double>(now_ - session.owes_since).count();
  session.latencies.add(taken, session.tick);
  std::optional<std::size_t> last;  // robots of a controller usually stand together
  for (const std::size_t robot : session.roster.robots) {
    const std::size_t controller = run_.layout.robots[robot].controller;
    if (last == controller) continue;
    latencies_[controller].add(taken, session.tick);
    last = controller;
  }
}

std::optional<wire::Fault> Barrier::check_tick(const Session& session) const {
  if (session.state == SessionState::ready) {
    return make_fault(ErrorCode::out_of_state, {},
                      "A Command answers an Observation; none was sent yet.");
  }
  const std::uint64_t tick = inbox_.command_tick();
  if (tick > session.tick) {
    return make_fault(
        ErrorCode::future_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {}.", tick, session.tick));
  }
  if (tick < session.tick) {
    return make_fault(
        ErrorCode::stale_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {} already.", tick, session.tick));
  }
  if (session.owes) return std::nullopt;
  if (session.has_missed) {
    return make_fault(ErrorCode::stale_tick, "tick",
                      fmt::format("Tick {} goes on without this Command.", tick));
  }
  return make_fault(ErrorCode::duplicate_tick, "tick",
                    fmt::format("Tick {} was answered already; the first answer counts.", tick));
}

void Barrier::pause() {
  is_paused_ = true;
  stand();
}

void Barrier::resume() {
  is_paused_ = false;
  if (!std::exchange(is_standing_, false)) return;
  for (Seat& seat : seats_) seat.free_since = now_;  // no deadline has run meanwhile
  for (const auto& session : sessions_) session->owes_since = now_;
  next_deadline_ = now_;
}

/// Tells those who have answered that no tick comes, once nobody owes an answer.
void Barrier::stand() {
  if (!observations_ || is_finished_ || !(is_standing_ || is_answered())) return;
  if (!std::exchange(is_standing_, true)) has_stood_ = true;
  outbox_.paused(observations_->tick);
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    const bool is_due = session->state == SessionState::stepping && !session->owes;
    if (!is_due || session->roster.empty()) continue;
    session->state = SessionState::paused;
    if (deliver(*session, outbox_) == Delivery::unreachable) gone.push_back(session.get());
  }
  for (Session* session : gone) lose(*session, "its connection is gone");
}

}  // namespace ziggurat::network
