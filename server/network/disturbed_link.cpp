// SPDX-License-Identifier: MIT
#include "network/disturbed_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::network {

using Case = v1::ServerMessage::MessageCase;

namespace {

constexpr std::size_t most_held_back = 1000;  // messages to a session, as many as a socket holds

std::string bytes_of(const wire::Outbox& message) {
  std::string bytes(message.size(), '\0');
  message.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

/// Whether every robot of the session has a deadline, so that the world does not wait forever.
bool has_deadlines(const v1::Welcome& welcome) {
  const auto waits = [](const v1::DeadlinePolicy& policy) {
    return policy.action() == v1::DeadlinePolicy::WAIT ||
           policy.action() == v1::DeadlinePolicy::ACTION_UNSPECIFIED;
  };
  if (welcome.has_deadline_policy()) return !waits(welcome.deadline_policy());
  return std::ranges::none_of(welcome.robots(), [&](const v1::RobotDescription& robot) {
    return waits(robot.deadline_policy());
  });
}

bool is_fatal(const v1::ServerMessage& message) {
  return message.message_case() == Case::kDisplaced || message.message_case() == Case::kRefusal ||
         (message.has_error() && message.error().severity() == v1::Error::FATAL);
}

}  // namespace

DisturbedLink::DisturbedLink(std::vector<Target> targets, std::uint64_t seed,
                             std::size_t most_bytes, SendBytes send)
    : targets_(std::move(targets)),
      seed_(seed),
      most_bytes_(most_bytes),
      send_(std::move(send)),
      lost_(targets_.size()) {}

DisturbedLink::Line* DisturbedLink::find(const std::string& connection) {
  const auto found = lines_.find(connection);
  return found == lines_.end() ? nullptr : &found->second;
}

/// One for each controller, and for the director, that the session has and that is disturbed.
std::vector<DisturbedLink::Path> DisturbedLink::paths_of(const v1::Welcome& welcome) const {
  std::vector<Path> paths;
  const auto add = [&](const Target& wanted, const std::string& name) {
    const auto target = std::ranges::find_if(targets_, [&](const Target& each) {
      return each.is_director == wanted.is_director && each.id == wanted.id;
    });
    if (target == targets_.end() || !target->injection.any()) return;
    const auto index = static_cast<std::size_t>(target - targets_.begin());
    if (std::ranges::find(paths, index, &Path::target) == paths.end())
      paths.push_back({index, name});
  };
  for (const v1::RobotDescription& robot : welcome.robots()) {
    add({.id = robot.controller()}, robot.controller() + "/" + robot.id());
  }
  if (welcome.has_director()) {
    const std::string& id = welcome.director().id();
    add({.id = id, .is_director = true}, id);
  }
  return paths;
}

void DisturbedLink::begin(const std::string& connection, const v1::Welcome& welcome) {
  std::vector<Path> paths = paths_of(welcome);
  if (paths.empty()) {
    lines_.erase(connection);
    return;
  }
  const bool would_lose = std::ranges::any_of(paths, [&](const Path& path) {
    const Injection& injection = targets_[path.target].injection;
    return injection.observations.loss > 0 || injection.commands.loss > 0;
  });
  Line& line = lines_[connection];
  line.paths = std::move(paths);
  line.may_lose = has_deadlines(welcome);
  if (!would_lose || line.may_lose) return;
  notices_.push_back(
      fmt::format("The session of {} has no deadline, so none of its messages is lost on purpose",
                  line.paths.front().name));
}

/// Draws the effect on a message. A message of several controllers has the longest of their delays,
/// and is lost if one of them loses it. Sessions without deadline lose nothing: the world would
/// wait without end.
Effect DisturbedLink::draw(const Line& line, Direction direction, std::uint64_t tick) {
  Effect effect;
  const bool is_observation = direction == Direction::observations;
  for (const Path& path : line.paths) {
    const Injection& injection = targets_[path.target].injection;
    const Effect drawn = draw_effect(is_observation ? injection.observations : injection.commands,
                                     seed_, path.name, direction, tick);
    effect.delay = std::max(effect.delay, drawn.delay);
    if (!drawn.is_lost || !line.may_lose) continue;
    effect.is_lost = true;
    ++(is_observation ? lost_[path.target].observations : lost_[path.target].commands);
  }
  return effect;
}

Delivery DisturbedLink::send(const std::string& connection, const wire::Outbox& out, Time now) {
  const v1::ServerMessage& message = out.message();
  if (message.has_welcome()) begin(connection, message.welcome());
  Line* line = find(connection);
  if (line == nullptr) return send_(connection, bytes_of(out), kind_of(out));
  Effect effect;
  if (message.has_observation()) {
    effect = draw(*line, Direction::observations, message.observation().tick());
  } else if (message.has_world_state()) {
    effect = draw(*line, Direction::observations, message.world_state().tick());
  }
  if (effect.is_lost) return Delivery::sent;
  const Delivery delivery =
      pass(connection, *line, {bytes_of(out), kind_of(out)}, now + effect.delay, now);
  if (delivery == Delivery::unreachable) {
    lines_.erase(connection);
  } else if (message.has_end() || is_fatal(message)) {
    end(connection, *line, message.has_end(), now);
  }
  return delivery;
}

/// Sends the message behind all that is held back, or holds it back, too.
Delivery DisturbedLink::pass(const std::string& connection, Line& line, Outgoing message,
                             Time arrival, Time now) {
  if (line.is_broken) return Delivery::unreachable;
  if (arrival <= now && line.outgoing.empty()) {
    return send_(connection, message.bytes, message.kind);
  }
  if (line.outgoing.size() >= most_held_back) return Delivery::congested;
  line.outgoing.push(arrival, std::move(message));
  return Delivery::sent;
}

/// The session or the run is over: what is under way to the client arrives at once.
/// @param is_orderly  what comes from the client still counts
void DisturbedLink::end(const std::string& connection, Line& line, bool is_orderly, Time now) {
  line.paths.clear();
  while (const auto message = line.outgoing.pop(never)) {
    send_(connection, message->bytes, message->kind);
  }
  if (is_orderly && !line.incoming.empty()) return line.incoming.hurry(now);
  lines_.erase(connection);
}

bool DisturbedLink::arrives(const Received& received, Time now) {
  Line* line = find(received.connection);
  if (line == nullptr) return true;
  const wire::Inbox::Kind kind =
      received.is_single_frame ? inbox_.parse(received.bytes) : wire::Inbox::Kind::malformed;
  Effect effect;
  const bool is_answer = kind == wire::Inbox::Kind::command || kind == wire::Inbox::Kind::direction;
  if (is_answer) effect = draw(*line, Direction::commands, inbox_.command_tick());
  if (effect.is_lost) return false;
  const bool is_last = kind == wire::Inbox::Kind::leave && inbox_.leave().robots.empty();
  if (is_last) line->paths.clear();
  if (effect.delay.count() == 0 && line->incoming.empty()) {
    if (is_last && line->outgoing.empty()) lines_.erase(received.connection);
    return true;
  }
  line->incoming_bytes += received.bytes.size();
  line->incoming.push(now + effect.delay,
                      {received.connection, std::string(received.bytes), received.is_single_frame,
                       received.access, received.skipped});
  if (line->incoming_bytes > most_bytes_) line->incoming.hurry(now);
  return false;
}

std::optional<Received> DisturbedLink::next(Time now) {
  for (auto entry = lines_.begin(); entry != lines_.end(); ++entry) {
    Line& line = entry->second;
    auto held = line.incoming.pop(now);
    if (!held) continue;
    arrived_ = std::move(*held);
    line.incoming_bytes -= arrived_.bytes.size();
    const bool is_over = line.paths.empty() && line.incoming.empty() && line.outgoing.empty();
    if (is_over) lines_.erase(entry);
    return Received{arrived_.connection, arrived_.bytes, arrived_.is_single_frame, arrived_.access,
                    arrived_.skipped};
  }
  return std::nullopt;
}

void DisturbedLink::release(Time now) {
  for (auto& [connection, line] : lines_) {
    while (const auto message = line.outgoing.pop(now)) {
      const Delivery delivery = send_(connection, message->bytes, message->kind);
      // The barrier learns of it with its next message, a heartbeat if nothing else.
      const bool is_lost = delivery == Delivery::congested && line.may_lose;
      if (delivery == Delivery::sent || is_lost) continue;
      line.is_broken = true;
      line.outgoing.clear();
    }
  }
}

Time DisturbedLink::next_event() const {
  Time next = never;
  for (const auto& [connection, line] : lines_) {
    next = std::min({next, line.outgoing.due(), line.incoming.due()});
  }
  return next;
}

std::vector<std::string> DisturbedLink::take_notices() { return std::exchange(notices_, {}); }

}  // namespace ziggurat::network
