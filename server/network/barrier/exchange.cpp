// SPDX-License-Identifier: MIT
#include "network/barrier/exchange.h"

#include <optional>

#include "network/barrier/answer_timing.h"
#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/peer_messages.h"
#include "network/barrier/timeouts.h"
#include "wire/command.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

namespace {

/// Checks the Command in `barrier.inbox`.
std::optional<wire::Fault> check_command(const Barrier& barrier, const Session& session,
                                         bool is_collecting) {
  if (session.state == SessionState::ready) {
    return make_fault(ErrorCode::out_of_state, {},
                      "A Command answers an Observation; none was sent yet.");
  }
  const auto epoch =
      session.minor >= wire::minor_with_epochs ? barrier.inbox.command_epoch() : std::nullopt;
  if (auto fault = check_epoch(session.pending_answer, epoch)) return fault;
  if (auto fault = check_tick(session.pending_answer, barrier.inbox.command_tick())) return fault;
  if (!is_collecting) {
    return make_fault(ErrorCode::out_of_state, {}, "No tick is being collected.");
  }
  if (auto fault = check_metrics(barrier, session)) return fault;
  return barrier.inbox.check(session.roster, barrier.run->layout);
}

/// Handles a Command that came after the End: its values have no effect, its log lines count.
void keep_log(Barrier& barrier, const Session& session) {
  if (barrier.inbox.check(session.roster, barrier.run->layout)) return;
  barrier.inbox.append_log(session.roster, barrier.journal.log());
}

/// Answers a Command that can't be taken.
void answer_bad_command(Barrier& barrier, Session& session, wire::Fault fault) {
  const StaleReason reason = take_stale_reason(session.pending_answer, fault.code);
  if (reason == StaleReason::none)
    return answer_fault(barrier, session.connection, &session, std::move(fault));
  if (reason == StaleReason::missed_deadline)
    measure_late_answer(barrier, session, barrier.inbox.command_tick());
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  send(barrier, session);
}

}  // namespace

void publish(Barrier& barrier, const world::Observations& observations,
             const std::vector<std::string>& tag_payloads, const wire::Truth* truth) {
  barrier.readings = {&observations, &tag_payloads};
  barrier.begin = {};
  truth != nullptr ? void(barrier.directors.truth.emplace(*truth))
                   : barrier.directors.truth.reset();
  for (auto& answer : barrier.directors.answers) answer.reset();
  barrier.directors.metrics.begin_tick();
  barrier.directors.ownership.begin_tick(barrier.now);
  barrier.metrics.begin_tick();
  barrier.gate.begin(observations.tick);
  barrier.timers.deadline = never;
  barrier.ownership.begin_tick(barrier.now);
  if (!barrier.ownership.all_taken() || !barrier.directors.ownership.all_taken())
    check_soon(barrier);
  barrier.sessions.for_each([&](Session& session) {
    if (session.state == SessionState::lost || !session.has_ticks()) return;
    session.pending_answer.is_resent = false;
    session.pending_answer.waited_before = {};
    if (const std::string_view why = observe(barrier, session); !why.empty())
      lose(barrier, session, why);
  });
  halt_if_paused(barrier);  // if no session owes an answer
}

void await_from(Barrier& barrier, Time now) {
  barrier.now = now;
  barrier.sessions.for_each([&](Session& session) {
    if (session.pending_answer.is_owed) session.pending_answer.waiting_since = now;
  });
}

std::string_view observe(Barrier& barrier, Session& session) {
  if (session.director) return show_world(barrier, session);
  const Connection* connection = barrier.connections.find(session.connection);
  const bool is_json = connection->encoding == wire::Encoding::json;
  const std::size_t limit =
      is_json ? wire::max_json_observation_bytes : wire::max_observation_bytes;
  const auto& [observations, tag_payloads] = barrier.readings;
  session.pending_answer.epoch = barrier.epoch;
  if (!session.observation.observation(session.roster, *observations, *tag_payloads, limit,
                                       epoch_for(barrier, session))) {
    tell_fatal(barrier, session.connection,
               make_fault(ErrorCode::too_large, {},
                          "The robots of this session heard and saw more at this tick than a "
                          "message can hold; share them among more "
                          "sessions (--lua-processes for scripts), or give their cameras and "
                          "radios a smaller range."));
    return "its robots heard and saw more at a tick than a message can hold; share them among more "
           "sessions "
           "(--lua-processes for scripts), or give their cameras and radios a smaller range";
  }
  session.state = SessionState::stepping;
  barrier.gate.await(session.pending_answer, barrier.now);
  expect_answer(barrier, session);
  session.liveness.last_sent = barrier.now;
  session.observation.encode(connection->encoding);
  const Delivery delivery = barrier.send(session.connection, session.observation);
  return lost_by(delivery, session);
}

std::optional<wire::Fault> check_metrics(const Barrier& barrier, const Session& session) {
  if (session.minor < wire::minor_with_metrics) return std::nullopt;
  if (auto fault = barrier.inbox.check_metrics(session.roster)) return fault;
  return barrier.metrics.check(barrier.inbox.metrics(session.roster));
}

void take_metrics(Barrier& barrier, const Session& session) {
  if (session.minor < wire::minor_with_metrics) return;
  barrier.metrics.set(barrier.inbox.metrics(session.roster));
}

bool handle_command(Barrier& barrier, Session& session, world::Commands* commands) {
  if (session.role == wire::Role::director) {
    answer_fault(barrier, session.connection, &session,
                 make_fault(ErrorCode::out_of_state, {},
                            "A director answers with a Direction, not with a Command."));
    return false;
  }
  if (session.state == SessionState::draining) {
    keep_log(barrier, session);
    return false;
  }
  if (auto fault = check_command(barrier, session, commands != nullptr)) {
    answer_bad_command(barrier, session, std::move(*fault));
    return false;
  }
  session.liveness.faults = 0;
  session.pending_answer.late_commands = session.pending_answer.stale_commands = 0;
  if (session.pending_answer.deadline) {
    for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
      if (!session.roster.taken[i]) barrier.deadlines.forgive(session.roster.robots[i]);
    }
  }
  if (session.pending_answer.is_resent) {
    wire::forget_radio_messages(session.roster, commands->radio_messages);
    wire::forget_markers(session.roster, commands->markers);
  }
  barrier.inbox.apply(session.roster, *commands);
  barrier.inbox.append_log(session.roster, barrier.journal.log());
  take_metrics(barrier, session);
  barrier.gate.settle(session.pending_answer, barrier.now);
  measure_answer(barrier, session);
  return true;
}

void zero_missing(Barrier& barrier, world::Commands& commands) {
  for (std::size_t robot = 0; robot < barrier.ownership.size(); ++robot) {
    if (!barrier.ownership[robot].has_left && !barrier.deadlines.is_zeroed(robot)) continue;
    wire::reset_commands(barrier.run->layout, robot, commands);
    barrier.deadlines.clear_zero(robot);
  }
}

void pause(Barrier& barrier) {
  barrier.gate.hold(TickGate::Hold::paused);
  halt_if_paused(barrier);
}

void halt_if_paused(Barrier& barrier) {
  TickGate& gate = barrier.gate;
  const bool is_paused = gate.is_held(TickGate::Hold::paused) && gate.tick() &&
                         !gate.is_held(TickGate::Hold::finished);
  if (!is_paused || !(gate.is_halted() || gate.is_answered())) return;
  if (!gate.is_halted()) barrier.calls.notify();
  gate.set_halted(true);
  barrier.sessions.for_each([&](Session& session) {
    const bool has_answered =
        session.state == SessionState::stepping && !session.pending_answer.is_owed;
    if (!has_answered || !session.has_ticks()) return;
    session.state = SessionState::paused;
    barrier.outbox.paused(tick_of(barrier));
    if (send(barrier, session) == Delivery::unreachable) {
      lose(barrier, session, "its connection is gone");
    }
  });
}

void resume(Barrier& barrier) {
  barrier.gate.release(TickGate::Hold::paused);
  if (!barrier.gate.is_halted()) return;
  barrier.gate.set_halted(false);
  barrier.ownership.restart(barrier.now);
  barrier.directors.ownership.restart(barrier.now);
  barrier.sessions.for_each([&](Session& session) {
    session.pending_answer.waiting_since = barrier.now;
    session.pending_answer.waited = session.pending_answer.waited_before = {};
  });
  check_soon(barrier);
}

}  // namespace ziggurat::network
