// What happens when time passes: missed deadlines and heartbeats.

#include <fmt/format.h>

#include <algorithm>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

using scene::DeadlineAction;
using std::chrono::milliseconds;

namespace {

// A session that owes an answer is taken to compute and not to read, perhaps for a night in a
// debugger: it must not find a queue full of heartbeats.
constexpr unsigned most_heartbeats = 60;
constexpr milliseconds rare_heartbeat{60'000};

}  // namespace

/// What holds for a robot unless its session wishes otherwise.
scene::DeadlinePolicy Barrier::policy_of(std::size_t robot) const {
  const std::size_t controller = run_.layout.robots[robot].controller;
  return controller < config_.deadlines.size() ? config_.deadlines[controller].policy
                                               : scene::DeadlinePolicy{};
}

/// A session answers for all its robots at once, so the longest of their deadlines counts. When the
/// last has left, what is still owed for it is due as before.
void Barrier::set_patience(Session& session) {
  if (session.roster.empty()) return;
  milliseconds longest{0};
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    const auto& deadline = seats_[session.roster.robots[i]].deadline;
    if (deadline.action == DeadlineAction::wait) {
      session.patience.reset();
      return;
    }
    longest = std::max(longest, milliseconds(deadline.wall_deadline_ms));
  }
  session.patience = longest;
  if (session.owes) next_deadline_ = std::min(next_deadline_, session.owes_since + longest);
}

void Barrier::check_deadlines() {
  next_deadline_ = Clock::time_point::max();
  if (!observations_ || is_finished_ || is_standing_ || is_stopped_) return;
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    if (!session->owes || !session->patience) continue;
    const auto due = session->owes_since + *session->patience;
    if (due > now_) {
      next_deadline_ = std::min(next_deadline_, due);
    } else if (!miss(*session)) {
      gone.push_back(session.get());
    }
  }
  for (std::size_t i = 0; i < seats_.size() && free_ > passed_; ++i) {
    Seat& seat = seats_[i];
    const bool is_free = seat.holder == nullptr && !seat.gone && !seat.passed;
    if (!is_free || seat.deadline.action == DeadlineAction::wait) continue;
    const auto due = seat.free_since + milliseconds(seat.deadline.wall_deadline_ms);
    if (due > now_) {
      next_deadline_ = std::min(next_deadline_, due);
    } else {
      seat.passed = true;
      ++passed_;
      miss(i);
    }
  }
  for (Session* session : gone) lose(*session, "its connection is gone");
  if (is_paused_) stand();
}

/// The tick goes on without the session's answer. False if the session can't be reached.
bool Barrier::miss(Session& session) {
  settle(session);
  session.has_missed = true;
  ++session.late_commands;
  ++session.misses;
  const auto& robots = session.roster.robots;
  const bool is_news = std::ranges::any_of(
      robots, [&](std::size_t robot) { return seats_[robot].misses_in_row == 0; });
  if (is_news) {
    note(fmt::format("{} ({}) missed its deadline of {} ms at tick {}", session.client,
                     robots_of(session), session.patience->count(), session.tick));
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!session.roster.gone[i]) miss(robots[i]);
  }
  auto fault = wire::make_fault(
      wire::ErrorCode::deadline_missed, {},
      fmt::format("Tick {} went on without an answer after {} ms.{}", session.tick,
                  session.patience->count(),
                  session.roster.empty() ? " The robots have left the barrier." : ""));
  fault.severity = wire::Severity::warning;
  fault.tick = session.tick;
  outbox_.error(fault);
  return deliver(session, outbox_) != Delivery::unreachable;
}

/// What the robot's policy says of a miss.
void Barrier::miss(std::size_t robot) {
  Seat& seat = seats_[robot];
  count_miss(robot);
  const bool is_beyond = seat.misses_in_row > seat.deadline.miss_budget;
  switch (seat.deadline.action) {
    case DeadlineAction::wait:
      return;
    case DeadlineAction::hold:
    case DeadlineAction::zero:
      if (seat.deadline.miss_budget > 0 && is_beyond) return drop(robot);
      seat.zeroed = seat.deadline.action == DeadlineAction::zero;
      return;
    case DeadlineAction::drop:
      if (is_beyond) drop(robot);
      return;
    case DeadlineAction::stop:
      if (is_beyond) stop_run(robot);
      return;
  }
}

void Barrier::count_miss(std::size_t robot) {
  ++seats_[robot].misses_in_row;
  const std::size_t controller = run_.layout.robots[robot].controller;
  if (last_missed_[controller] == observations_->tick) return;
  last_missed_[controller] = observations_->tick;
  ++missed_ticks_[controller];
}

void Barrier::drop(std::size_t robot) {
  const auto& layout = run_.layout.robots[robot];
  report_.dropped.push_back(
      fmt::format("robot {} (controller '{}') is dropped at tick {}: {} missed in a row, {}",
                  layout.id, run_.controllers[layout.controller].id, observations_->tick,
                  seats_[robot].misses_in_row, to_text(seats_[robot].deadline)));
  mark_gone(robot);
}

void Barrier::stop_run(std::size_t robot) {
  is_stopped_ = true;
  if (!report_.stopped.empty()) return;
  const auto& layout = run_.layout.robots[robot];
  report_.stopped = fmt::format(
      "controller '{}' of robot {} did not answer at tick {}: its deadline policy {} stops the run",
      run_.controllers[layout.controller].id, layout.id, observations_->tick,
      to_text(seats_[robot].deadline));
}

void Barrier::send_heartbeats() {
  next_heartbeat_ = now_ + config_.heartbeat;
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    if (session->state == SessionState::lost) continue;
    const bool is_rare = session->owes && session->heartbeats >= most_heartbeats;
    const auto interval = is_rare ? std::max(rare_heartbeat, config_.heartbeat) : config_.heartbeat;
    if (session->last_sent + interval <= now_) {
      outbox_.heartbeat(++heartbeats_);
      ++session->heartbeats;
      if (deliver(*session, outbox_) == Delivery::unreachable) gone.push_back(session.get());
    }
    next_heartbeat_ = std::min(next_heartbeat_, session->last_sent + interval);
  }
  for (Session* session : gone) lose(*session, "its connection is gone");
}

}  // namespace ziggurat::network
