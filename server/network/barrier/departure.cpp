// SPDX-License-Identifier: MIT
#include "network/barrier/departure.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "network/barrier/answer_timing.h"
#include "network/barrier/directing.h"
#include "network/barrier/exchange.h"
#include "network/barrier/peer_messages.h"
#include "network/barrier/timeouts.h"
#include "wire/messages.h"

namespace ziggurat::network {

namespace {

/// Frees a robot that the session holds.
void release(Barrier& barrier, const Session& holder, std::size_t robot, Claim claim) {
  const bool is_skipped =
      barrier.gate.has_missed(holder.pending_answer);  // waited for once, not twice
  const Time since = is_skipped ? holder.pending_answer.waiting_since : barrier.now;
  barrier.ownership.release(robot, claim == Claim::kept ? holder.id : SessionId::none, since,
                            is_skipped ? InTick::skipped : InTick::awaited,
                            barrier.gate.waited(holder.pending_answer, barrier.now));
  if (!is_skipped) expect_answer(barrier, robot);
}

/// Index of a robot in the Welcome of its session.
std::size_t position_of(const Session& session, std::size_t robot) {
  const auto& robots = session.roster.robots;
  return static_cast<std::size_t>(std::ranges::lower_bound(robots, robot) - robots.begin());
}

void release_all(Barrier& barrier, Session& holder, Claim claim) {
  release_director(barrier, holder, claim);
  for (const std::size_t robot : holder.roster.robots) {
    if (barrier.ownership[robot].holder == holder.id) release(barrier, holder, robot, claim);
  }
}

/// Unbinds the session's connection.
void unbind(Barrier& barrier, const Session& session) {
  barrier.connections.unbind(session.connection);
  barrier.calls.forget(session.id);
  if (!barrier.on_standing) return;
  barrier.on_standing(session.connection, Standing::none, longest_message(barrier, nullptr));
}

/// Ends a session whose last robots another client has taken over.
void displace(Barrier& barrier, Session& session, const std::string& by) {
  if (session.state != SessionState::lost) {
    const std::string robots = robots_of(barrier, session);
    barrier.outbox.displaced(by, fmt::format("{} has taken over {}.", by, robots));
    send(barrier, session);
    note(barrier, &session, fmt::format("{} ({}) was displaced by {}", session.client, robots, by));
  }
  erase(barrier, session);
}

/// False if the session is lost now.
bool tell_one_taken(Barrier& barrier, Session& session, std::size_t position,
                    const std::string& by) {
  const std::string& id = barrier.run->layout.robots[session.roster.robots[position]].id;
  auto fault = wire::make_fault(wire::ErrorCode::not_yours, {},
                                fmt::format("{} has taken over robot '{}'.", by, id), id);
  fault.severity = wire::Severity::warning;
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  if (send(barrier, session) != Delivery::unreachable) return true;
  lose(barrier, session, "its connection is gone");
  return false;
}

/// The session, connected or lost, goes on without these of its robots.
void take(Barrier& barrier, Session& session, std::span<const std::size_t> robots,
          const std::string& by) {
  for (const std::size_t robot : robots) {
    const bool is_held = barrier.ownership[robot].holder == session.id;
    is_held ? release(barrier, session, robot, Claim::dropped)
            : barrier.ownership.drop_claim(robot);
    session.roster.hand_over(position_of(session, robot));
  }
  note(barrier, &session,
       fmt::format("{} has taken over {} from {}, which keeps {}", by, names_of(barrier, robots),
                   session.client, robots_of(barrier, session)));
  if (session.state == SessionState::lost) return;
  update_deadline(barrier, session);
  for (const std::size_t robot : robots) {
    if (!tell_one_taken(barrier, session, position_of(session, robot), by)) return;
  }
}

}  // namespace

void handle_leave(Barrier& barrier, Session& session) {
  const bool has_no_robots_left =
      session.state == SessionState::draining && session.roster.robots.empty();
  const bool is_waiting = session.state == SessionState::hello;
  if (is_waiting) return erase(barrier, session);
  if (session.role == wire::Role::director) return leave_directing(barrier, session);
  if (has_no_robots_left) return erase(barrier, session);
  auto fault = check_metrics(barrier, session);
  if (!fault) fault = barrier.inbox.check(session.roster, barrier.run->layout);
  if (fault) {
    return answer_fault(barrier, session.connection, &session, std::move(*fault));
  }
  session.liveness.faults = 0;
  barrier.inbox.append_log(session.roster, barrier.journal.log());
  take_metrics(barrier, session);
  const wire::Leave leave = barrier.inbox.leave();
  const bool is_whole = leave.robots.empty();
  std::vector<std::size_t> positions(leave.robots.begin(), leave.robots.end());
  for (std::size_t i = 0; is_whole && i < session.roster.robots.size(); ++i) positions.push_back(i);
  for (const std::size_t position : positions) {
    if (session.roster.gone[position]) continue;
    const std::size_t robot = session.roster.robots[position];
    if (leave.reason == wire::LeaveReason::failed) {
      barrier.journal.fail(robot, leave.message, session.pending_answer.tick);
    } else if (session.state != SessionState::draining) {
      barrier.journal.depart(robot, session.pending_answer.tick);
    }
    remove_robot(barrier, robot);
  }
  if (is_whole) erase(barrier, session);
}

void lose(Barrier& barrier, Session& session, std::string_view why) {
  if (session.state == SessionState::lost) return;
  if (session.state != SessionState::draining && session.state != SessionState::hello) {
    note(barrier, &session,
         fmt::format("{} ({}) is lost: {}", session.client, robots_of(barrier, session), why));
  }
  const bool may_resume = session.state != SessionState::draining && session.has_ticks();
  if (!may_resume) return erase(barrier, session);
  barrier.gate.settle(session.pending_answer, barrier.now);
  unbind(barrier, session);
  give_up_answers(barrier, session);
  session.state = SessionState::lost;
  session.lease_end = barrier.now + barrier.config.lease;
  release_all(barrier, session, Claim::kept);
}

void disconnect(Barrier& barrier, const std::string& connection) {
  Session* session = barrier.sessions.find(barrier.connections.session_of(connection));
  if (session != nullptr) lose(barrier, *session, "its connection is gone");
  barrier.connections.erase(connection);
  halt_if_paused(barrier);
}

void take_over(Barrier& barrier, std::span<const std::size_t> robots, const std::string& by) {
  std::map<SessionId, std::vector<std::size_t>> taken;
  for (const std::size_t robot : robots) {
    const Ownership::Entry& entry = barrier.ownership[robot];
    taken[entry.owner()].push_back(robot);
  }
  for (const auto& [id, theirs] : taken) {
    Session* session = barrier.sessions.find(id);
    if (session == nullptr) continue;  // none had these
    const bool is_whole =
        theirs.size() + session->roster.gone_count == session->roster.robots.size();
    is_whole ? displace(barrier, *session, by) : take(barrier, *session, theirs, by);
  }
}

bool tell_taken(Barrier& barrier, Session& session, const std::string& by) {
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.taken[i] && !tell_one_taken(barrier, session, i, by)) return false;
  }
  return true;
}

void erase(Barrier& barrier, Session& session) {
  give_up_answers(barrier, session);
  barrier.gate.settle(session.pending_answer, barrier.now);
  if (session.state != SessionState::lost) unbind(barrier, session);
  release_all(barrier, session, Claim::dropped);
  for (const std::size_t robot : session.roster.robots) {
    if (barrier.ownership[robot].claimant == session.id) barrier.ownership.drop_claim(robot);
  }
  barrier.sessions.erase(session.id);
}

bool end(Barrier& barrier, Session& session, std::string why) {
  barrier.gate.settle(session.pending_answer, barrier.now);
  session.state = SessionState::draining;
  barrier.outbox.end({wire::EndReason::finished, std::move(why), tick_of(barrier)});
  return send(barrier, session) == Delivery::sent;
}

void finish(Barrier& barrier, const wire::End& end) {
  barrier.gate.hold(TickGate::Hold::finished);
  barrier.sessions.for_each([&](Session& session) {
    if (session.state == SessionState::draining) return;  // it is told already
    give_up_answers(barrier, session);
    if (session.state == SessionState::lost) return erase(barrier, session);
    barrier.gate.settle(session.pending_answer, barrier.now);
    barrier.outbox.end(end);
    const bool is_told = send(barrier, session) == Delivery::sent;
    const bool may_answer =
        session.has_ticks() || session.role == wire::Role::controller;  // with its last log lines
    if (!is_told || !may_answer) return erase(barrier, session);
    session.state = SessionState::draining;
  });
}

void refuse_waiting(Barrier& barrier) {
  wire::Refusal refusal{wire::make_fault(wire::ErrorCode::out_of_state, {},
                                         "There is no world: it could not be loaded."),
                        {},
                        {}};
  refusal.fault.severity = wire::Severity::fatal;
  barrier.sessions.for_each([&](Session& session) {
    if (session.state != SessionState::hello) return;
    barrier.inbox.parse(session.waiting_hello.hello);
    refusal.client_version = barrier.inbox.hello().version;
    barrier.outbox.refusal(refusal);
    send(barrier, session);
    erase(barrier, session);
  });
}

void remove_robot(Barrier& barrier, std::size_t robot) {
  const Ownership::Entry entry = barrier.ownership[robot];
  if (entry.has_left) return;
  barrier.ownership.leave(robot);
  const bool is_held = entry.holder != SessionId::none;
  Session* session = barrier.sessions.find(is_held ? entry.holder : entry.claimant);
  if (session == nullptr) return;
  give_up_answers(barrier, *session);
  session->roster.leave(position_of(*session, robot));
  const bool is_over = session->state == SessionState::lost && session->roster.empty();
  if (is_over) return erase(barrier, *session);
  update_deadline(barrier, *session);
}

}  // namespace ziggurat::network
