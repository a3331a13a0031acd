// SPDX-License-Identifier: MIT
#include "network/barrier/timeouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "network/barrier/answer_timing.h"
#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/exchange.h"
#include "network/barrier/peer_messages.h"
#include "wire/messages.h"

namespace ziggurat::network {

using scene::DeadlineAction;
using std::chrono::milliseconds;

namespace {

// A session that owes an answer is taken to compute and not to read, perhaps for a night in a
// debugger: its queue must not fill with heartbeats.
constexpr unsigned most_heartbeats = 60;
constexpr milliseconds rare_heartbeat{60'000};

constexpr milliseconds between_notices{10'000};  // on misses of one session

void drop(Barrier& barrier, std::size_t robot) {
  const auto& layout = barrier.run->layout.robots[robot];
  barrier.journal.drop(fmt::format(
      "robot {} (controller '{}') is dropped at tick {}: {} missed in a row, {}", layout.id,
      barrier.run->controllers[layout.controller].id, tick_of(barrier),
      barrier.deadlines.misses_in_row(robot), to_text(barrier.deadlines.policy(robot))));
  remove_robot(barrier, robot);
}

void stop(Barrier& barrier, std::size_t robot) {
  barrier.gate.hold(TickGate::Hold::stopped);
  const auto& layout = barrier.run->layout.robots[robot];
  barrier.journal.stop(fmt::format(
      "controller '{}' of robot {} did not answer at tick {}: its deadline policy {} stops the run",
      barrier.run->controllers[layout.controller].id, layout.id, tick_of(barrier),
      to_text(barrier.deadlines.policy(robot))));
}

/// The tick goes on without an answer for the robot.
void miss(Barrier& barrier, std::size_t robot) {
  switch (barrier.deadlines.miss(robot, tick_of(barrier))) {
    case Consequence::none:
    case Consequence::zero:
      return;
    case Consequence::drop:
      return drop(barrier, robot);
    case Consequence::stop:
      return stop(barrier, robot);
  }
}

/// The tick goes on without the director.
/// @returns  it has left the barrier for good
bool miss_director(Barrier& barrier, std::size_t director) {
  Directors& directors = barrier.directors;
  directors.answers[director].reset();  // also of a session before, which answered and was lost
  const std::string& id = directors.all[director].id;
  const std::string policy = to_text(directors.deadlines.policy(director));
  switch (directors.deadlines.miss(director, tick_of(barrier))) {
    case Consequence::none:
    case Consequence::zero:
      return false;
    case Consequence::drop:
      barrier.journal.drop(
          fmt::format("director '{}' is dropped at tick {}: {} missed in a row, {}", id,
                      tick_of(barrier), directors.deadlines.misses_in_row(director), policy));
      return true;
    case Consequence::stop:
      barrier.gate.hold(TickGate::Hold::stopped);
      barrier.journal.stop(fmt::format(
          "director '{}' did not answer at tick {}: its deadline policy {} stops the run", id,
          tick_of(barrier), policy));
      return false;
  }
  return false;
}

/// Sends a warning on the session's tick. False if the session can't be told.
bool warn(Barrier& barrier, Session& session, wire::Fault fault) {
  fault.severity = wire::Severity::warning;
  fault.tick = session.pending_answer.tick;
  barrier.outbox.error(fault);
  return send(barrier, session) != Delivery::unreachable;
}

bool tell_missed(Barrier& barrier, Session& session, milliseconds deadline) {
  return warn(barrier, session,
              wire::make_fault(
                  wire::ErrorCode::deadline_missed, {},
                  fmt::format("Tick {} went on without an answer after {} ms.{}",
                              session.pending_answer.tick, deadline.count(),
                              session.has_ticks() ? "" : " What it drives has left the barrier.")));
}

/// @param robots  positions in the session
bool tell_dropped(Barrier& barrier, Session& session, std::vector<std::uint32_t> robots) {
  if (robots.empty() || session.minor < wire::minor_with_events) return true;
  auto fault = wire::make_fault(
      wire::ErrorCode::robots_dropped, {},
      fmt::format("{} of this session's robots left the barrier for good, because too many answers "
                  "were missing.",
                  robots.size()));
  fault.dropped = std::move(robots);
  return warn(barrier, session, std::move(fault));
}

/// Prints a notice at once, or with the next one if the last is too recent.
void note_miss(Barrier& barrier, Session& session, milliseconds deadline) {
  Session::UnreportedMisses& unreported = session.unreported;
  if (unreported.misses++ == 0) unreported.first_tick = session.pending_answer.tick;
  if (barrier.now < unreported.until) return;
  const std::string ticks = unreported.misses == 1
                                ? fmt::format("at tick {}", session.pending_answer.tick)
                                : fmt::format("at {} of the ticks {} to {}", unreported.misses,
                                              unreported.first_tick, session.pending_answer.tick);
  note(barrier, &session,
       fmt::format("{} ({}) missed its deadline of {} ms {}", session.client,
                   robots_of(barrier, session), deadline.count(), ticks));
  unreported = {0, 0, barrier.now + between_notices};
}

/// The tick goes on without the session's answer.
void miss(Barrier& barrier, Session& session) {
  barrier.gate.miss(session.pending_answer, barrier.now);
  expect_late_answer(barrier, session);
  ++session.misses;
  const auto& robots = session.roster.robots;
  const milliseconds deadline = *session.pending_answer.deadline;
  note_miss(barrier, session, deadline);
  std::vector<std::uint32_t> dropped;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    miss(barrier, robots[i]);
    if (session.roster.gone[i]) dropped.push_back(static_cast<std::uint32_t>(i));
  }
  if (session.director && miss_director(barrier, *session.director)) {
    remove_director(barrier, session);
  }
  const bool is_told =
      tell_missed(barrier, session, deadline) && tell_dropped(barrier, session, std::move(dropped));
  if (!is_told) {
    lose(barrier, session, "its connection is gone");
  }
}

void wake_at(Barrier& barrier, Time time) {
  barrier.timers.deadline = std::min(barrier.timers.deadline, time);
}

void check_sessions(Barrier& barrier) {
  barrier.sessions.for_each([&](Session& session) {
    if (!session.pending_answer.is_owed || !session.pending_answer.deadline) return;
    const Time deadline = session.pending_answer.due_at(*session.pending_answer.deadline);
    if (deadline > barrier.now) return wake_at(barrier, deadline);
    miss(barrier, session);
  });
}

/// Deadline of a free robot or director whose policy is not to wait.
Time deadline_of(const Ownership::Entry& entry, const scene::DeadlinePolicy& policy) {
  return entry.free_since + time_left(milliseconds(policy.wall_deadline_ms), entry.waited);
}

void check_free_robots(Barrier& barrier) {
  std::optional<std::size_t> controller;  // of the robot before
  for (std::size_t robot = 0; robot < barrier.ownership.size() && barrier.ownership.is_awaited();
       ++robot) {
    const Ownership::Entry& entry = barrier.ownership[robot];
    if (entry.holder != SessionId::none || entry.has_left || entry.is_skipped) continue;
    const scene::DeadlinePolicy& policy = barrier.deadlines.policy(robot);
    if (policy.action == DeadlineAction::wait) continue;
    const Time deadline = deadline_of(entry, policy);
    if (deadline > barrier.now) {
      wake_at(barrier, deadline);
    } else {
      barrier.ownership.skip(robot, barrier.now);
      if (controller != barrier.deadlines.controller(robot)) {
        controller = barrier.deadlines.controller(robot);
        measure_absence(barrier, robot, entry.free_since);
      }
      miss(barrier, robot);
    }
  }
}

void check_free_directors(Barrier& barrier) {
  Directors& directors = barrier.directors;
  for (std::size_t i = 0; i < directors.all.size(); ++i) {
    const Ownership::Entry entry = directors.ownership[i];
    const scene::DeadlinePolicy& policy = directors.deadlines.policy(i);
    const bool is_awaited = entry.holder == SessionId::none && !entry.has_left && !entry.is_skipped;
    if (!is_awaited || policy.action == DeadlineAction::wait) continue;
    const Time deadline = deadline_of(entry, policy);
    if (deadline > barrier.now) {
      wake_at(barrier, deadline);
      continue;
    }
    directors.ownership.skip(i, barrier.now);
    if (!miss_director(barrier, i)) continue;
    Session* claimant = barrier.sessions.find(entry.claimant);
    directors.ownership.leave(i);
    if (claimant != nullptr) erase(barrier, *claimant);
  }
}

void check_deadlines(Barrier& barrier) {
  barrier.timers.deadline = never;
  const TickGate& gate = barrier.gate;
  const bool is_running = gate.tick() && !gate.is_halted() &&
                          !gate.is_held(TickGate::Hold::finished) &&
                          !gate.is_held(TickGate::Hold::stopped);
  if (!is_running) return;
  check_sessions(barrier);
  check_free_robots(barrier);
  check_free_directors(barrier);
}

/// Sends a heartbeat to the session, if it is time.
Delivery send_heartbeat(Barrier& barrier, Session& session) {
  const milliseconds usual = barrier.config.heartbeat;
  const bool is_rare =
      session.pending_answer.is_owed && session.liveness.heartbeats >= most_heartbeats;
  const milliseconds interval = is_rare ? std::max(rare_heartbeat, usual) : usual;
  Delivery delivery = Delivery::sent;
  if (session.liveness.last_sent + interval <= barrier.now) {
    if (session.state == SessionState::hello) {
      barrier.outbox.loading(barrier.progress.share, barrier.progress.message);
    } else {
      barrier.outbox.heartbeat(++barrier.heartbeats);
    }
    ++session.liveness.heartbeats;
    delivery = send(barrier, session);
  }
  barrier.timers.heartbeat =
      std::min(barrier.timers.heartbeat, session.liveness.last_sent + interval);
  return delivery;
}

/// @param unreachable  called with sessions that can't be reached
template <class Unreachable>
void send_heartbeats(Barrier& barrier, Unreachable unreachable) {
  if (barrier.now < barrier.timers.heartbeat) return;
  barrier.timers.heartbeat = barrier.now + barrier.config.heartbeat;
  barrier.sessions.for_each([&](Session& session) {
    if (session.state == SessionState::lost) return;
    if (send_heartbeat(barrier, session) == Delivery::unreachable) unreachable(session);
  });
}

}  // namespace

void advance(Barrier& barrier, Time now) {
  barrier.now = now;
  if (barrier.now >= barrier.timers.deadline) check_deadlines(barrier);
  send_heartbeats(barrier,
                  [&](Session& session) { lose(barrier, session, "its connection is gone"); });
  halt_if_paused(barrier);  // a session that was lost may have been the last that owed
}

void keep_alive(Barrier& barrier, Time now) {
  barrier.now = now;
  send_heartbeats(barrier, [](Session&) {});  // the next advance() finds that it is gone
}

Time next_event(const Barrier& barrier) {
  return std::min(barrier.timers.deadline, barrier.timers.heartbeat);
}

void check_soon(Barrier& barrier) { barrier.timers.deadline = barrier.now; }

void expect_answer(Barrier& barrier, std::size_t robot) {
  const scene::DeadlinePolicy& policy = barrier.deadlines.policy(robot);
  if (policy.action == DeadlineAction::wait) return;
  wake_at(barrier, barrier.now + milliseconds(policy.wall_deadline_ms));
}

void expect_answer(Barrier& barrier, const Session& session) {
  if (session.pending_answer.deadline)
    wake_at(barrier, session.pending_answer.due_at(*session.pending_answer.deadline));
}

void update_deadline(Barrier& barrier, Session& session) {
  if (session.director) {
    const auto& policy = barrier.directors.deadlines.policy(*session.director);
    session.pending_answer.deadline.reset();
    if (policy.action != DeadlineAction::wait) {
      session.pending_answer.deadline = milliseconds(policy.wall_deadline_ms);
    }
  }
  // With its last robot gone, what it still owes keeps its deadline.
  if (session.roster.empty()) return;
  milliseconds longest{0};
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    const auto& policy = barrier.deadlines.policy(session.roster.robots[i]);
    if (policy.action == DeadlineAction::wait) {
      session.pending_answer.deadline.reset();
      return;
    }
    longest = std::max(longest, milliseconds(policy.wall_deadline_ms));
  }
  session.pending_answer.deadline = longest;
  if (session.pending_answer.is_owed) expect_answer(barrier, session);
}

}  // namespace ziggurat::network
