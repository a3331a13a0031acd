// Who has which robot, and how sessions end.

#include <fmt/format.h>

#include <algorithm>

#include "network/barrier.h"

namespace ziggurat::network {

void Barrier::take_seat(std::size_t robot, Session& session) {
  Seat& seat = seats_[robot];
  --free_;
  if (seat.passed) --passed_;
  seat.passed = false;
  seat.zeroed = false;
  seat.holder = &session;
  seat.claimant = nullptr;
}

/// @param claimant  the lost session that may take it up again; null: nobody
void Barrier::free_seat(std::size_t robot, Session* claimant) {
  Seat& seat = seats_[robot];
  ++free_;
  seat.holder = nullptr;
  seat.claimant = claimant;
  seat.free_since = now_;
  if (seat.deadline.action == scene::DeadlineAction::wait) return;
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
  if (session.state != SessionState::lost) peers_.at(session.peer).session = nullptr;
  for (const std::size_t robot : session.roster.robots) {
    if (seats_[robot].holder == &session) free_seat(robot, nullptr);
    if (seats_[robot].claimant == &session) seats_[robot].claimant = nullptr;
  }
  std::erase_if(sessions_, [&](const auto& entry) { return entry.get() == &session; });
}

void Barrier::remove_robots(std::span<const std::size_t> robots) {
  for (const std::size_t robot : robots) {
    Session* session = seats_[robot].holder;
    mark_gone(robot);
    if (session != nullptr && session->roster.empty()) settle(*session);
  }
  if (is_paused_) stand();
}

}  // namespace ziggurat::network
