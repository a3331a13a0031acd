// Who has which robot, and how sessions end.

#include <fmt/format.h>

#include <algorithm>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

void Barrier::take_seat(std::size_t robot, Session& session) {
  Seat& seat = seats_[robot];
  --free_;
  if (seat.passed) --passed_;
  seat.passed = false;
  seat.zeroed = false;
  seat.was_held = true;
  seat.holder = &session;
  seat.claimant = nullptr;
}

/// The tick does not wait again for a robot whose session has missed it.
/// @param robot     held by a session
/// @param claimant  the lost session that may take it up again; null: nobody
void Barrier::free_seat(std::size_t robot, Session* claimant) {
  Seat& seat = seats_[robot];
  const Session& holder = *seat.holder;
  ++free_;
  seat.passed = holder.has_missed && observations_ && holder.tick == observations_->tick;
  if (seat.passed) ++passed_;
  seat.free_since = seat.passed ? holder.owes_since : now_;
  seat.holder = nullptr;
  seat.claimant = claimant;
  if (seat.passed || seat.deadline.action == scene::DeadlineAction::wait) return;
  const std::chrono::milliseconds deadline{seat.deadline.wall_deadline_ms};
  next_deadline_ = std::min(next_deadline_, now_ + deadline);
}

/// Takes a robot out of the barrier for good.
void Barrier::mark_gone(std::size_t robot) {
  Seat& seat = seats_[robot];
  if (seat.gone) return;
  if (seat.holder == nullptr) --free_;
  if (seat.passed) --passed_;
  Session* session = seat.holder != nullptr ? seat.holder : seat.claimant;
  seat.gone = true;
  seat.passed = false;
  seat.holder = nullptr;
  seat.claimant = nullptr;
  if (session == nullptr) return;
  const auto& robots = session->roster.robots;
  const auto found = std::lower_bound(robots.begin(), robots.end(), robot);
  session->roster.leave(static_cast<std::size_t>(found - robots.begin()));
  if (session->state == SessionState::lost && session->roster.empty()) return erase(*session);
  set_patience(*session);
}

/// The session owes nothing any more.
void Barrier::settle(Session& session) {
  if (!session.owes) return;
  session.owes = false;
  --owing_;
}

/// Its robots wait for somebody to take them; it may resume.
void Barrier::lose(Session& session, std::string_view why) {
  if (session.state == SessionState::lost) return;
  if (session.state != SessionState::draining) {
    note(fmt::format("{} ({}) is lost: {}", session.client, robots_of(session), why));
  }
  settle(session);
  stop_delays(session);
  session.incoming.clear();
  session.incoming_bytes = 0;
  peers_.at(session.peer).session = nullptr;
  const bool can_resume = session.state != SessionState::draining && !session.roster.empty();
  session.state = SessionState::lost;
  session.lease_end = now_ + config_.lease;
  for (const std::size_t robot : session.roster.robots) {
    if (seats_[robot].holder == &session) free_seat(robot, can_resume ? &session : nullptr);
  }
  if (!can_resume) erase(session);
}

/// Its robots are free, and somebody is about to take them.
void Barrier::displace(Session& session, const std::string& by) {
  outbox_.displaced(by, fmt::format("{} has taken over {}.", by, robots_of(session)));
  deliver(session, outbox_);
  note(fmt::format("{} ({}) was displaced by {}", session.client, robots_of(session), by));
  erase(session);
}

void Barrier::erase(Session& session) {
  settle(session);
  stop_delays(session);
  if (session.state != SessionState::lost) peers_.at(session.peer).session = nullptr;
  for (const std::size_t robot : session.roster.robots) {
    if (seats_[robot].holder == &session) free_seat(robot, nullptr);
    if (seats_[robot].claimant == &session) seats_[robot].claimant = nullptr;
  }
  std::erase_if(sessions_, [&](const auto& entry) { return entry.get() == &session; });
}

void Barrier::add_robots(std::span<const std::string> scripts,
                         const world::Observations& observations,
                         std::span<const std::string> tag_payloads) {
  if (observations_) {  // who takes them at this tick is told what they sense
    observations_ = observations;
    tag_payloads_.assign(tag_payloads.begin(), tag_payloads.end());
  }
  run_.scripts.resize(seats_.size());
  run_.scripts.insert(run_.scripts.end(), scripts.begin(), scripts.end());
  for (std::size_t robot = seats_.size(); robot < run_.layout.robots.size(); ++robot) {
    Seat& seat = seats_.emplace_back();
    seat.deadline = policy_of(robot);
    seat.free_since = now_;
    seat.passed = observations_.has_value();
    ++free_;
    if (seat.passed) ++passed_;
  }
}

void Barrier::remove_robots(std::span<const std::size_t> robots, const std::string& why) {
  for (const std::size_t robot : robots) {
    Session* session = seats_[robot].holder;
    mark_gone(robot);
    if (session == nullptr) continue;
    if (session->roster.empty()) settle(*session);
    if (!why.empty()) say_removed(*session, robot, why);
  }
  if (is_paused_) stand();
}

/// Tells a session that a robot of it was taken out of the world.
void Barrier::say_removed(Session& session, std::size_t robot, const std::string& why) {
  if (session.state == SessionState::draining) return;
  if (session.roster.empty()) {
    if (!say_end(session, why)) lose(session, "its connection is gone");
    return;
  }
  auto fault = wire::make_fault(wire::ErrorCode::not_yours, {}, why, run_.layout.robots[robot].id);
  fault.severity = wire::Severity::warning;
  fault.tick = observations_ ? observations_->tick : 0;
  outbox_.error(fault);
  if (deliver(session, outbox_) == Delivery::unreachable) lose(session, "its connection is gone");
}

/// There are no more ticks for the session. False if it can't be told.
bool Barrier::say_end(Session& session, std::string why) {
  settle(session);
  session.state = SessionState::draining;
  outbox_.end({wire::EndReason::finished, std::move(why), observations_ ? observations_->tick : 0});
  return deliver(session, outbox_) == Delivery::sent;
}

/// Ends a session that has robots which are about to be forgotten; it may still say goodbye.
void Barrier::forget(Session& session) {
  if (session.state == SessionState::lost) return erase(session);
  const bool is_told = session.state == SessionState::draining ||
                       say_end(session,
                               "The world was reset, and has not all robots of this "
                               "session any more.");
  if (!is_told) return erase(session);
  for (const std::size_t robot : session.roster.robots) {
    if (seats_[robot].holder == &session) free_seat(robot, nullptr);
  }
  session.roster = {};
}

/// Those that the layout has no more.
void Barrier::forget_robots() {
  const std::size_t count = run_.layout.robots.size();
  if (seats_.size() <= count) return;
  std::vector<Session*> over;
  for (const auto& session : sessions_) {
    const auto& robots = session->roster.robots;  // ascending
    if (!robots.empty() && robots.back() >= count) over.push_back(session.get());
  }
  for (Session* session : over) forget(*session);
  for (std::size_t robot = count; robot < seats_.size(); ++robot) mark_gone(robot);
  seats_.resize(count);
  run_.scripts.resize(std::min(run_.scripts.size(), count));
  const auto is_forgotten = [&](const auto& said) { return said.robot >= count; };
  std::erase_if(report_.log, is_forgotten);
  std::erase_if(report_.failures, is_forgotten);
}

}  // namespace ziggurat::network
