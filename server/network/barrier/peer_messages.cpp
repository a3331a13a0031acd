// SPDX-License-Identifier: MIT
#include "network/barrier/peer_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "network/barrier/departure.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;

namespace {

constexpr std::size_t robots_named = 3;  // in messages that could name hundreds

}  // namespace

Delivery send(Barrier& barrier, const std::string& connection) {
  const Connection* known = barrier.connections.find(connection);
  barrier.outbox.encode(known == nullptr ? wire::Encoding::binary : known->encoding);
  return barrier.send(connection, barrier.outbox);
}

Delivery send(Barrier& barrier, Session& session) {
  session.liveness.last_sent = barrier.now;
  return send(barrier, session.connection);
}

std::string_view lost_by(Delivery delivery, const Session& session) {
  const bool may_miss = delivery == Delivery::congested && session.pending_answer.deadline;
  if (delivery == Delivery::sent || may_miss) return {};
  return "its connection is gone, or it does not read";
}

void note(Barrier& barrier, const Session* session, std::string_view sentence) {
  const bool has_part_in_ticks = standing_of(session) == Standing::controller;
  has_part_in_ticks ? barrier.journal.note(sentence, barrier.now)
                    : barrier.journal.note_other(sentence, barrier.now);
}

void answer_fault(Barrier& barrier, const std::string& connection, Session* session,
                  wire::Fault fault, std::optional<std::uint64_t> request) {
  fault.tick = tick_of(barrier);
  const bool is_last = session != nullptr && ++session->liveness.faults > barrier.config.max_faults;
  if (is_last) {
    fault.code = ErrorCode::too_many;
    fault.message = fmt::format("{} bad messages in a row; the last one: {}",
                                session->liveness.faults, fault.message);
  }
  if (session == nullptr || is_last) fault.severity = wire::Severity::fatal;
  if (request && !is_last) {
    barrier.outbox.response(*request, fault);
  } else {
    barrier.outbox.error(fault);
  }
  const Delivery delivery = send(barrier, connection);
  const std::string client = session == nullptr        ? "A peer without a session"
                             : session->client.empty() ? "A client that waits for the world"
                                                       : session->client;
  const bool ends_with_it =
      session != nullptr && session->role == wire::Role::director;  // and says why
  if (!ends_with_it || is_last) {
    note(barrier, session,
         fmt::format("{} was answered {}: {}", client, to_string(fault.code), fault.message));
  }
  if (session == nullptr) return;
  if (is_last) return lose(barrier, *session, "it was closed for its bad messages");
  if (delivery == Delivery::unreachable) lose(barrier, *session, "its connection is gone");
}

void tell_fatal(Barrier& barrier, const std::string& connection, wire::Fault fault) {
  fault.severity = wire::Severity::fatal;
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  send(barrier, connection);
}

void answer_malformed(Barrier& barrier, const std::string& connection, Session* session,
                      std::string_view why) {
  answer_fault(
      barrier, connection, session,
      wire::make_fault(ErrorCode::malformed, {},
                       fmt::format("Not a ClientMessage of ziggurat.v1: {}.",
                                   why.empty() ? "one ZeroMQ frame holds one message" : why)));
}

Standing standing_of(const Session* session) {
  if (session == nullptr) return Standing::none;
  if (session->state == SessionState::hello) return Standing::waiting;
  const bool has_ticks =
      session->role == wire::Role::controller || session->role == wire::Role::director;
  if (has_ticks) return Standing::controller;
  return session->role == wire::Role::supervisor ? Standing::supervisor : Standing::observer;
}

std::size_t longest_message(const Barrier& barrier, const Session* session) {
  const std::size_t most = barrier.config.max_message_bytes;
  const Standing standing = standing_of(session);
  return longest_message(standing, standing == Standing::controller
                                       ? std::min(most, session->command_limits.bytes)
                                       : most);
}

std::uint64_t tick_of(const Barrier& barrier) {
  return barrier.gate.tick().value_or(barrier.begin.tick);
}

std::string names_of(const Barrier& barrier, std::span<const std::size_t> robots) {
  std::string text;
  for (const std::size_t robot : robots.first(std::min(robots_named, robots.size()))) {
    text += (text.empty() ? "" : ", ") + barrier.run->layout.robots[robot].id;
  }
  if (robots.size() > robots_named)
    text += fmt::format(" and {} more", robots.size() - robots_named);
  return text.empty() ? "no robots" : text;
}

std::string robots_of(const Barrier& barrier, const Session& session) {
  if (session.director) {
    return fmt::format("director '{}'", barrier.directors.all[*session.director].id);
  }
  std::vector<std::size_t> robots;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (!session.roster.gone[i]) robots.push_back(session.roster.robots[i]);
  }
  return names_of(barrier, robots);
}

std::optional<std::uint64_t> epoch_for(const Barrier& barrier, const Session& session) {
  if (session.minor < wire::minor_with_epochs) return std::nullopt;
  return barrier.epoch;
}

}  // namespace ziggurat::network
