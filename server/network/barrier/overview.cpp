// SPDX-License-Identifier: MIT
#include "network/barrier/overview.h"

#include <algorithm>

namespace ziggurat::network {

namespace {

using State = wire::SessionStatus::State;

double seconds(Time::duration time) { return std::chrono::duration<double>(time).count(); }

State state_of(const Session& session) {
  switch (session.state) {
    case SessionState::hello:
    case SessionState::ready:
      return State::ready;
    case SessionState::stepping:
      return session.pending_answer.is_owed ? State::owing : State::answered;
    case SessionState::paused:
      return State::paused;
    case SessionState::draining:
      return State::draining;
    case SessionState::lost:
      return State::lost;
  }
  return State::unspecified;
}

wire::SessionStatus status_of(const Barrier& barrier, const Session& session, Time now) {
  wire::SessionStatus status;
  status.client = session.client;
  status.role = session.role;
  status.state = state_of(session);
  status.tick = session.pending_answer.tick;
  if (session.director) {
    status.director = barrier.directors.all[*session.director].id;
    status.deadline = barrier.directors.deadlines.policy(*session.director);
  }
  const auto& robots = session.roster.robots;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    status.robots.push_back(barrier.run->layout.robots[robots[i]].id);
    status.deadline = barrier.deadlines.policy(robots[i]);
  }
  if (session.pending_answer.is_owed)
    status.wall_waiting_s = seconds(now - session.pending_answer.waiting_since);
  if (session.state == SessionState::lost && !robots.empty()) {
    status.wall_waiting_s = seconds(now - barrier.ownership[robots.front()].free_since);
  }
  if (session.state == SessionState::lost && session.director) {
    status.wall_waiting_s =
        seconds(now - barrier.directors.ownership[*session.director].free_since);
  }
  status.wall_last_message_s = seconds(now - session.liveness.last_received);
  status.latency = session.latencies.recent();
  status.misses = session.misses;
  return status;
}

}  // namespace

namespace {

bool has_any(const Barrier& barrier, const Session& session, const std::vector<std::string>& ids) {
  const auto is_meant = [&](const std::string& id) {
    return std::ranges::find(ids, id) != ids.end();
  };
  if (session.director) return is_meant(barrier.directors.all[*session.director].id);
  const auto& robots = session.roster.robots;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!session.roster.taken[i] && is_meant(barrier.run->layout.robots[robots[i]].id)) return true;
  }
  return false;
}

}  // namespace

Need need_of(const Barrier& barrier, const std::vector<std::string>& ids) {
  Need need = Need::nothing;
  if (ids.empty()) return need;
  barrier.sessions.for_each([&](const Session& session) {
    const bool has_end =
        session.pending_answer.deadline.has_value() || session.state == SessionState::draining;
    if (has_end || !session.has_ticks() || !has_any(barrier, session, ids)) return;
    need = std::max(need, session.pending_answer.is_owed ? Need::answer : Need::answers);
  });
  return need;
}

std::vector<RobotStatus> robot_status(const Barrier& barrier) {
  std::vector<RobotStatus> result(barrier.ownership.size());
  for (std::size_t robot = 0; robot < result.size(); ++robot) {
    const Ownership::Entry& entry = barrier.ownership[robot];
    RobotStatus& status = result[robot];
    status.deadline = barrier.deadlines.policy(robot);
    status.was_held = entry.was_held;
    if (entry.has_left) {
      status.membership = RobotStatus::Membership::gone;
    } else if (const Session* holder = barrier.sessions.find(entry.holder)) {
      status.membership = RobotStatus::Membership::held;
      status.holder = holder->client;
      status.token = holder->token;
      status.can_restore = holder->can_restore;
      status.awaited = holder->pending_answer.is_owed;
      status.awaited_since = holder->pending_answer.waiting_since;
      status.last_message = holder->liveness.last_received;
    } else {
      const Session* claimant = barrier.sessions.find(entry.claimant);
      if (claimant != nullptr) {
        status.holder = claimant->client;
        status.token = claimant->token;
        status.can_restore = claimant->can_restore;
      }
      status.awaited = !entry.is_skipped;
      status.awaited_since = entry.free_since;
    }
  }
  return result;
}

namespace {

/// Appends the metrics of directors, in the order of their ids.
void append_named(const Directors& directors, const std::vector<wire::Metric>& metrics,
                  std::vector<world::Metric>& to) {
  for (const std::size_t director : directors.by_id) {
    for (const wire::Metric& metric : metrics) {
      if (metric.robot != director) continue;
      to.push_back({directors.all[director].id, metric.name, metric.value});
    }
  }
}

}  // namespace

std::vector<world::Metric> named(const Barrier& barrier, const std::vector<wire::Metric>& metrics) {
  std::vector<world::Metric> result;
  result.reserve(metrics.size());
  for (const wire::Metric& metric : metrics) {
    result.push_back({barrier.run->layout.robots[metric.robot].id, metric.name, metric.value});
  }
  return result;
}

std::vector<world::Metric> metrics_of_tick(const Barrier& barrier) {
  auto metrics = named(barrier, barrier.metrics.of_tick());
  append_named(barrier.directors, barrier.directors.metrics.of_tick(), metrics);
  return metrics;
}

void fill(const Barrier& barrier, Time now, wire::Status& status) {
  status.metrics = named(barrier, barrier.metrics.last());
  append_named(barrier.directors, barrier.directors.metrics.last(), status.metrics);
  barrier.sessions.for_each(
      [&](const Session& session) { status.sessions.push_back(status_of(barrier, session, now)); });
  for (std::size_t robot = 0; robot < barrier.ownership.size(); ++robot) {
    const Ownership::Entry& entry = barrier.ownership[robot];
    const std::string& id = barrier.run->layout.robots[robot].id;
    const bool is_free = entry.holder == SessionId::none && entry.claimant == SessionId::none;
    if (entry.has_left) {
      status.gone_robots.push_back(id);
    } else if (is_free) {
      status.free_robots.push_back(id);
    }
  }
  for (std::size_t director = 0; director < barrier.directors.ownership.size(); ++director) {
    const Ownership::Entry& entry = barrier.directors.ownership[director];
    if (entry.owner() == SessionId::none && !entry.has_left)
      status.free_directors.push_back(barrier.directors.all[director].id);
  }
}

std::vector<DirectorStatus> director_status(const Barrier& barrier) {
  std::vector<DirectorStatus> result;
  const Directors& directors = barrier.directors;
  for (std::size_t i = 0; i < directors.all.size(); ++i) {
    const Ownership::Entry& entry = directors.ownership[i];
    const Session* session = barrier.sessions.find(entry.owner());
    DirectorStatus status;
    status.id = directors.all[i].id;
    status.is_held = entry.holder != SessionId::none;
    status.has_left = entry.has_left;
    status.was_held = entry.was_held;
    status.waits = directors.deadlines.policy(i).action == scene::DeadlineAction::wait;
    if (session != nullptr) {
      status.client = session->client;
      status.can_restore = session->can_restore;
    }
    status.is_awaited = entry.holder == SessionId::none ? !entry.has_left && !entry.is_skipped
                                                        : session->pending_answer.is_owed;
    result.push_back(std::move(status));
  }
  return result;
}

}  // namespace ziggurat::network
