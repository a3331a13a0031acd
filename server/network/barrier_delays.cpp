// Messages that are held back or lost on purpose, and let go when their time has come.

#include <fmt/format.h>

#include <algorithm>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

using Kind = wire::Inbox::Kind;

namespace {

constexpr std::size_t most_held_back = 1000;  // messages to a session, as many as a socket holds

}  // namespace

/// One for each of its controllers whose messages are disturbed.
void Barrier::set_paths(Session& session) {
  session.paths.clear();
  for (const std::size_t robot : session.roster.robots) {
    const auto& layout = run_.layout.robots[robot];
    const std::size_t controller = layout.controller;
    if (controller >= config_.injections.size() || !config_.injections[controller].any()) continue;
    const auto is_its = [&](const auto& path) { return path.controller == controller; };
    if (std::ranges::any_of(session.paths, is_its)) continue;
    session.paths.push_back({controller, run_.controllers[controller].id + "/" + layout.id});
  }
  if (session.patience || session.paths.empty()) return;
  const bool would_lose = std::ranges::any_of(session.paths, [&](const auto& path) {
    const Injection& injection = config_.injections[path.controller];
    return injection.observations.loss > 0 || injection.commands.loss > 0;
  });
  if (would_lose) {
    note(fmt::format("{} ({}) is waited for, so none of its messages is lost on purpose",
                     session.client, robots_of(session)));
  }
}

/// Of a message that belongs to several controllers: the longest delay, and lost if one loses it.
/// Nothing is lost for a session that the world waits for: it would wait for ever.
Fate Barrier::fate_of(const Session& session, Direction direction, std::uint64_t tick) {
  Fate fate;
  for (const auto& path : session.paths) {
    const Injection& injection = config_.injections[path.controller];
    const bool is_observation = direction == Direction::observations;
    const Fate drawn = draw_fate(is_observation ? injection.observations : injection.commands,
                                 run_.seed, path.name, direction, tick);
    fate.delay = std::max(fate.delay, drawn.delay);
    if (!drawn.is_lost || !session.patience) continue;
    fate.is_lost = true;
    ++(is_observation ? lost_[path.controller].observations : lost_[path.controller].commands);
  }
  return fate;
}

/// Sends the session's observation, now or later or not at all.
Delivery Barrier::send_observation(Session& session) {
  const Fate fate = fate_of(session, Direction::observations, session.tick);
  if (fate.is_lost) return Delivery::sent;
  if (fate.delay.count() == 0) return deliver(session, session.observation);
  session.last_sent = now_;
  session.observation.encode(session.encoding);
  return hold_back(session, session.observation, fate.delay);
}

Delivery Barrier::hold_back(Session& session, wire::Outbox& message, Clock::duration delay) {
  if (session.outgoing.size() >= most_held_back) return Delivery::congested;
  session.outgoing.push(now_ + delay, std::exchange(message, wire::Outbox()));
  next_departure_ = std::min(next_departure_, session.outgoing.due());
  return Delivery::sent;
}

/// Whether the message in hand is lost, or stays behind to be taken later.
bool Barrier::is_held_back(Session& session, Kind kind, std::string_view bytes) {
  Fate fate;
  if (kind == Kind::command) {
    fate = fate_of(session, Direction::commands, inbox_.command_tick());
  }
  if (fate.is_lost) return true;
  if (fate.delay.count() == 0 && session.incoming.empty()) return false;
  session.incoming_bytes += bytes.size();
  session.incoming.push(now_ + fate.delay, std::string(bytes));
  next_arrival_ = std::min(next_arrival_, session.incoming.due());
  if (session.incoming_bytes > 2 * config_.max_message_bytes) {
    auto fault = wire::make_fault(wire::ErrorCode::too_many, {},
                                  "More messages are under way than the server can hold back.");
    fault.severity = wire::Severity::fatal;
    fault.tick = session.tick;
    outbox_.error(fault);
    deliver(session, outbox_);
    lose(session, "more of its messages are under way than can be held back");
  }
  return true;
}

/// Sends what was held back long enough.
void Barrier::send_due() {
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    while (auto message = session->outgoing.pop(now_)) {
      const Delivery delivery = send_(session->peer, *message);
      const bool may_miss = delivery == Delivery::congested && session->patience;
      if (delivery == Delivery::sent || may_miss) continue;
      gone.push_back(session.get());
      session->outgoing.clear();
    }
  }
  for (Session* session : gone) lose(*session, "its connection is gone, or it does not read");
  next_departure_ = Clock::time_point::max();
  for (const auto& session : sessions_) {
    next_departure_ = std::min(next_departure_, session->outgoing.due());
  }
}

void Barrier::receive_due(world::Commands* commands) {
  if (now_ < next_arrival_) return;
  for (std::size_t i = 0; i < sessions_.size();) {
    Session& session = *sessions_[i];
    const auto bytes = session.incoming.pop(now_);
    if (!bytes) {
      ++i;
      continue;
    }
    session.incoming_bytes -= bytes->size();
    take(session, inbox_.parse(*bytes), commands);  // sessions may end by that
  }
  if (is_paused_) stand();
  next_arrival_ = Clock::time_point::max();
  for (const auto& session : sessions_) {
    next_arrival_ = std::min(next_arrival_, session->incoming.due());
  }
}

/// The session or the run is over: what is under way arrives at once.
void Barrier::stop_delays(Session& session) {
  session.paths.clear();
  while (auto message = session.outgoing.pop(Clock::time_point::max())) {
    send_(session.peer, *message);
  }
  session.incoming.hurry(now_);
  next_arrival_ = std::min(next_arrival_, session.incoming.due());
}

}  // namespace ziggurat::network
