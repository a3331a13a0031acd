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
      return session.turn.owes ? State::owing : State::answered;
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
  status.tick = session.turn.tick;
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
  if (session.turn.owes) status.wall_waiting_s = seconds(now - session.turn.owes_since);
  if (session.state == SessionState::lost && !robots.empty()) {
    status.wall_waiting_s = seconds(now - barrier.seats[robots.front()].free_since);
  }
  if (session.state == SessionState::lost && session.director) {
    status.wall_waiting_s = seconds(now - barrier.directors.seats[*session.director].free_since);
  }
  status.wall_last_message_s = seconds(now - session.contact.last_received);
  status.latency = session.latencies.recent();
  status.misses = session.misses;
  return status;
}

}  // namespace

namespace {

bool has_any(const Barrier& barrier, const Session& session, const std::vector<std::string>& ids) {
  const auto is_meant = [&](const std::string& id) { return std::ranges::find(ids, id) != ids.end(); };
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
    const bool has_end = session.turn.patience.has_value() || session.state == SessionState::draining;
    if (has_end || !session.has_ticks() || !has_any(barrier, session, ids)) return;
    need = std::max(need, session.turn.owes ? Need::answer : Need::answers);
  });
  return need;
}

std::vector<RobotStatus> robot_status(const Barrier& barrier) {
  std::vector<RobotStatus> result(barrier.seats.size());
  for (std::size_t robot = 0; robot < result.size(); ++robot) {
    const Seats::Seat& seat = barrier.seats[robot];
    RobotStatus& status = result[robot];
    status.deadline = barrier.deadlines.policy(robot);
    status.was_held = seat.was_held;
    if (seat.has_left) {
      status.membership = RobotStatus::Membership::gone;
    } else if (const Session* holder = barrier.sessions.find(seat.holder)) {
      status.membership = RobotStatus::Membership::held;
      status.holder = holder->client;
      status.token = holder->token;
      status.can_restore = holder->can_restore;
      status.awaited = holder->turn.owes;
      status.awaited_since = holder->turn.owes_since;
      status.last_message = holder->contact.last_received;
    } else {
      const Session* claimant = barrier.sessions.find(seat.claimant);
      if (claimant != nullptr) {
        status.holder = claimant->client;
        status.token = claimant->token;
        status.can_restore = claimant->can_restore;
      }
      status.awaited = !seat.is_skipped;
      status.awaited_since = seat.free_since;
    }
  }
  return result;
}

namespace {

/// Those of directors follow, in the order of their ids.
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
  for (std::size_t robot = 0; robot < barrier.seats.size(); ++robot) {
    const Seats::Seat& seat = barrier.seats[robot];
    const std::string& id = barrier.run->layout.robots[robot].id;
    const bool is_free = seat.holder == SessionId::none && seat.claimant == SessionId::none;
    if (seat.has_left) {
      status.gone_robots.push_back(id);
    } else if (is_free) {
      status.free_robots.push_back(id);
    }
  }
  for (std::size_t director = 0; director < barrier.directors.seats.size(); ++director) {
    const Seats::Seat& seat = barrier.directors.seats[director];
    if (seat.owner() == SessionId::none && !seat.has_left) status.free_directors.push_back(barrier.directors.all[director].id);
  }
}

}  // namespace ziggurat::network
