// SPDX-License-Identifier: MIT
#include "network/barrier/population.h"

#include <algorithm>
#include <utility>

#include "network/barrier/admission.h"
#include "network/barrier/answer_timing.h"
#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/exchange.h"
#include "network/barrier/peer_messages.h"
#include "wire/messages.h"

namespace ziggurat::network {

namespace {

/// Tells a session that one of its robots was taken out of the world.
void tell_removed(Barrier& barrier, Session& session, std::size_t robot, const std::string& why) {
  if (session.state == SessionState::draining) return;
  if (session.roster.empty()) {
    if (!end(barrier, session, why)) lose(barrier, session, "its connection is gone");
    return;
  }
  auto fault =
      wire::make_fault(wire::ErrorCode::not_yours, {}, why, barrier.run->layout.robots[robot].id);
  fault.severity = wire::Severity::warning;
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  if (send(barrier, session) == Delivery::unreachable) {
    lose(barrier, session, "its connection is gone");
  }
}

/// Tells sessions with robots of this controller, including robots that left, about a new robot.
void tell_spawned(Barrier& barrier, std::size_t robot) {
  const auto& robots = barrier.run->layout.robots;
  const std::size_t controller = robots[robot].controller;
  barrier.sessions.for_each([&](Session& session) {
    const bool is_connected =
        session.state != SessionState::lost && session.state != SessionState::draining;
    const bool is_concerned = std::ranges::any_of(session.roster.robots, [&](std::size_t own) {
      return robots[own].controller == controller;
    });
    if (!is_connected || !is_concerned || session.minor < wire::minor_with_events) return;
    barrier.outbox.spawned(
        {robots[robot].id, barrier.run->controllers[controller].id, tick_of(barrier)});
    if (send(barrier, session) == Delivery::unreachable) {
      lose(barrier, session, "its connection is gone");
    }
  });
}

/// Ends a session with robots that are about to be forgotten. Its client may still send a Leave.
void end_without_robots(Barrier& barrier, Session& session) {
  const bool is_told =
      session.state == SessionState::draining ||
      (session.state != SessionState::lost &&
       end(barrier, session,
           "The world was reset, and has not all robots of this session any more."));
  if (!is_told) return erase(barrier, session);
  for (const std::size_t robot : session.roster.robots) {
    if (barrier.ownership[robot].holder != session.id) continue;
    barrier.ownership.release(robot, SessionId::none, barrier.now, InTick::awaited, {});
  }
  session.roster = {};
}

/// Forgets robots that the layout has no more, or that are others now.
/// @param count  the first ones, which stay
void forget_robots(Barrier& barrier, std::size_t count) {
  if (barrier.ownership.size() <= count) return;
  barrier.sessions.for_each([&](Session& session) {
    const auto& robots = session.roster.robots;  // ascending
    if (!robots.empty() && robots.back() >= count) end_without_robots(barrier, session);
  });
  for (std::size_t robot = count; robot < barrier.ownership.size(); ++robot)
    remove_robot(barrier, robot);
  barrier.ownership.shrink(count);
  barrier.deadlines.shrink(count);
  barrier.journal.shrink(count);
  auto& scripts = barrier.run->scripts;
  scripts.resize(std::min(scripts.size(), count));
}

}  // namespace

void open(Barrier& barrier, const wire::Run& run, const Config& config) {
  barrier.run.emplace(run);
  barrier.progress = {1, "The world is loaded."};
  barrier.deadlines = Deadlines(config.deadlines, run.controllers.size());
  barrier.reactions.are_kept = config.keeps_reactions;
  barrier.answer_times.resize(run.controllers.size());
  add_robots(barrier, run.scripts, {});
  barrier.directors.deadline_of_others = config.deadline_of_others;
  add_directors(barrier, config.deadlines);
}

void add_robots(Barrier& barrier, std::span<const std::string> scripts,
                const TickReadings& readings) {
  // A session that takes them at this tick is told what they sense.
  if (barrier.gate.tick()) barrier.readings = readings;
  const auto& robots = barrier.run->layout.robots;
  auto& known = barrier.run->scripts;
  known.resize(barrier.ownership.size());
  known.insert(known.end(), scripts.begin(), scripts.end());
  const InTick in_tick = barrier.gate.tick() ? InTick::skipped : InTick::awaited;
  for (std::size_t robot = barrier.ownership.size(); robot < robots.size(); ++robot) {
    barrier.ownership.add(barrier.now, in_tick);
    barrier.deadlines.add(robots[robot].controller);
    tell_spawned(barrier, robot);
  }
}

void remove_robots(Barrier& barrier, std::span<const std::size_t> robots, const std::string& why) {
  for (const std::size_t robot : robots) {
    const SessionId holder = barrier.ownership[robot].holder;
    remove_robot(barrier, robot);
    Session* session = barrier.sessions.find(holder);
    if (session == nullptr) continue;
    if (session->roster.empty()) barrier.gate.settle(session->pending_answer, barrier.now);
    if (!why.empty()) tell_removed(barrier, *session, robot, why);
  }
  halt_if_paused(barrier);
}

void restart(Barrier& barrier, wire::Restart restart) {
  barrier.run->seed = restart.seed;
  ++barrier.epoch;
  barrier.sessions.for_each([&](Session& session) { give_up_answers(barrier, session); });
  ++barrier.reactions.world;
  barrier.metrics.clear();
  forget_directions(barrier);
  forget_robots(barrier,
                restart.snapshot ? restart.snapshot->robots : barrier.run->layout.robots.size());
  barrier.gate.clear();  // a session that begins now gets no tick of the former world
  barrier.readings = {};
  barrier.begin = {};
  if (restart.snapshot) barrier.begin = {restart.snapshot->tick, *restart.snapshot->commands};
  barrier.deadlines.reset();
  barrier.sessions.for_each([&](Session& session) {
    barrier.gate.give_up(session.pending_answer, barrier.now);
    const bool has_ticks =
        session.state == SessionState::stepping || session.state == SessionState::paused;
    if (!has_ticks || !session.has_ticks()) return;
    restart.epoch = epoch_for(barrier, session);
    barrier.outbox.restart(session.roster, restart);
    if (send(barrier, session) == Delivery::unreachable) {
      lose(barrier, session, "its connection is gone");
    }
  });
}

}  // namespace ziggurat::network
