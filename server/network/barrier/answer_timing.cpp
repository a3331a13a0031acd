// SPDX-License-Identifier: MIT
#include "network/barrier/answer_timing.h"

#include <algorithm>
#include <optional>

#include "network/barrier/peer_messages.h"

namespace ziggurat::network {
namespace {

double seconds_since(const Barrier& barrier, Time begin) {
  return std::chrono::duration<double>(barrier.now - begin).count();
}

/// Calls visit(first robot) for each controller with robots of the session that have not left.
/// Robots of a controller usually stand together.
template <class Visit>
void for_each_controller(const Barrier& barrier, const Session& session, Visit visit) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    const std::size_t robot = session.roster.robots[i];
    const std::size_t controller = barrier.deadlines.controller(robot);
    if (last != controller) visit(robot);
    last = controller;
  }
}

void keep(Barrier& barrier, std::size_t robot, std::uint64_t tick, double seconds,
          Reaction::Kind kind) {
  const std::size_t controller = barrier.deadlines.controller(robot);
  barrier.reactions.all.push_back({seconds, static_cast<std::uint32_t>(tick),
                                   barrier.reactions.world, static_cast<std::uint32_t>(robot),
                                   static_cast<std::uint16_t>(controller), kind});
}

/// Records the ticks that the session has missed, up to one of them.
/// @param answered  tick that is answered late, if any; the others are not, as commands keep their
///                  order
void record_missed(Barrier& barrier, Session& session, std::uint64_t last,
                   std::optional<std::uint64_t> answered) {
  auto& missed = session.pending_answer.missed;
  const auto end = std::ranges::find_if(missed, [&](const auto& one) { return one.tick > last; });
  for (auto one = missed.begin(); one != end; ++one) {
    const double seconds = seconds_since(barrier, one->sent);
    const auto kind = one->tick == answered ? Reaction::Kind::late : Reaction::Kind::unanswered;
    for_each_controller(barrier, session,
                        [&](std::size_t robot) { keep(barrier, robot, one->tick, seconds, kind); });
  }
  missed.erase(missed.begin(), end);
}

}  // namespace

void measure_answer(Barrier& barrier, Session& session) {
  const PendingAnswer& answer = session.pending_answer;
  const double seconds = seconds_since(barrier, answer.waiting_since);
  session.latencies.add(seconds);
  for_each_controller(barrier, session, [&](std::size_t robot) {
    barrier.answer_times[barrier.deadlines.controller(robot)].add(seconds);
  });
  if (!barrier.reactions.are_kept) return;
  record_missed(barrier, session, answer.tick, {});
  for_each_controller(barrier, session, [&](std::size_t robot) {
    keep(barrier, robot, answer.tick, seconds, Reaction::Kind::in_time);
  });
}

void expect_late_answer(Barrier& barrier, Session& session) {
  if (!barrier.reactions.are_kept) return;
  session.pending_answer.missed.push_back(
      {session.pending_answer.tick, session.pending_answer.waiting_since});
}

void measure_late_answer(Barrier& barrier, Session& session, std::uint64_t tick) {
  record_missed(barrier, session, tick, tick);
}

void give_up_answers(Barrier& barrier, Session& session) {
  record_missed(barrier, session, session.pending_answer.tick, {});
}

void measure_absence(Barrier& barrier, std::size_t robot, Time since) {
  if (!barrier.reactions.are_kept) return;
  keep(barrier, robot, tick_of(barrier), seconds_since(barrier, since), Reaction::Kind::unanswered);
}

}  // namespace ziggurat::network
