// SPDX-License-Identifier: MIT
#include "network/barrier/dispatch.h"

#include <fmt/format.h>

#include <utility>

#include "network/barrier/admission.h"
#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/exchange.h"
#include "network/barrier/peer_messages.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using InboxKind = wire::Inbox::Kind;

namespace {

// A message counts once more for each of these of its size [bytes].
constexpr std::size_t bytes_per_message = 4 * kibibyte;
constexpr std::size_t bytes_per_message_of_controller = 16 * kibibyte;

void handle_heartbeat(Barrier& barrier, const Session& session) {
  barrier.outbox.heartbeat(barrier.inbox.heartbeat());
  // If the connection is gone, the next observation or heartbeat of ours finds out.
  send(barrier, session.connection);
}

/// True for a question of a director on which the tick waits: that wait bounds how many there are.
bool handle_request(Barrier& barrier, Session& session) {
  const std::uint64_t id = barrier.inbox.request_id();
  wire::Request request = barrier.inbox.request();
  auto fault = check_request(request, session.role);
  if (!fault) fault = barrier.calls.add(session.id, session.connection, std::move(request));
  if (fault) {
    answer_fault(barrier, session.connection, &session, std::move(*fault), id);
    return false;
  }
  session.liveness.faults = 0;
  return session.role == wire::Role::director && session.pending_answer.is_owed;
}

std::size_t size_of(const Received& received) { return received.bytes.size() + received.skipped; }

/// Why a message can't be looked into, if it can't.
std::optional<wire::Fault> check_size(const Barrier& barrier, const Received& received,
                                      const Session* session) {
  const std::size_t size = size_of(received), allowed = longest_message(barrier, session);
  // A Hello of this user's own processes may be longer than those of others: the socket knows.
  const bool is_too_long = received.skipped > 0 || size > barrier.config.max_message_bytes ||
                           (session != nullptr && size > allowed);
  if (!is_too_long) return std::nullopt;
  return make_fault(ErrorCode::too_large, {},
                    fmt::format("The message has {} bytes; {} are allowed.", size, allowed));
}

/// Whether the connection may send one more message; if not, it is told once.
bool may_send(Barrier& barrier, const std::string& id, Connection& connection, Session* session) {
  const auto verdict = barrier.connections.spend(connection, barrier.now);
  if (verdict == Connections::Verdict::accepted) return true;
  if (verdict == Connections::Verdict::refused_and_told) return false;
  tell_fatal(
      barrier, id,
      make_fault(
          ErrorCode::too_many, {},
          fmt::format("More than {} messages a second, besides those that answer an Observation.",
                      barrier.config.rate.per_second)));
  if (session != nullptr) {
    lose(barrier, *session, "it was closed because it sends too many messages");
  } else {
    note(barrier, nullptr,
         "A peer without a session sends too many messages and is not answered any more.");
  }
  return false;
}

/// The message in `barrier.inbox`, of a session. True if it is the Command that was owed, or a
/// question before it.
bool handle(Barrier& barrier, Session& session, InboxKind kind, world::Commands* commands) {
  const bool is_waiting = session.state == SessionState::hello;
  if (kind == InboxKind::leave) {
    handle_leave(barrier, session);
  } else if (kind == InboxKind::heartbeat) {
    handle_heartbeat(barrier, session);
  } else if (is_waiting || kind == InboxKind::hello) {
    answer_fault(barrier, session.connection, &session,
                 make_fault(ErrorCode::out_of_state, {},
                            is_waiting ? "The world is loading, and the Hello waits for it."
                                       : "This session has had its Hello already."));
  } else if (kind == InboxKind::request) {
    return handle_request(barrier, session);
  } else if (kind == InboxKind::direction) {
    return handle_direction(barrier, session, commands != nullptr);
  } else {
    return handle_command(barrier, session, commands);
  }
  return false;
}

}  // namespace

void receive(Barrier& barrier, const Received& received, world::Commands* commands) {
  const std::string& id = received.connection;
  Connection& connection = barrier.connections.receive_from(id, barrier.now);
  Session* session = barrier.sessions.find(connection.session);
  if (session != nullptr) {
    session->liveness.last_received = barrier.now;
    session->liveness.heartbeats = 0;
  }
  const auto encoding =
      received.is_single_frame ? wire::encoding_of(received.bytes) : received.several_frames;
  if (session == nullptr) connection.encoding = encoding;
  if (!may_send(barrier, id, connection, session)) return;
  const bool is_controller = standing_of(session) == Standing::controller;
  const std::size_t charge =
      size_of(received) / (is_controller ? bytes_per_message_of_controller : bytes_per_message);
  Connections::charge(connection, charge);
  if (!received.is_single_frame) return answer_malformed(barrier, id, session, {});
  if (auto fault = check_size(barrier, received, session)) {
    return answer_fault(barrier, id, session, std::move(*fault));
  }
  if (encoding != connection.encoding) {
    const bool is_json = connection.encoding == wire::Encoding::json;
    return answer_malformed(
        barrier, id, session,
        is_json ? "this session talks JSON" : "this session does not talk JSON");
  }
  const std::size_t most = is_controller ? session->command_limits.fields : wire::most_fields;
  const InboxKind kind = barrier.inbox.parse(received.bytes, most);
  if (kind == InboxKind::malformed) {
    return answer_malformed(barrier, id, session, barrier.inbox.complaint());
  }
  if (kind == InboxKind::too_large) {
    return answer_fault(
        barrier, id, session,
        make_fault(
            ErrorCode::too_large, {},
            fmt::format("The message has more fields than the {} that this session needs.", most)));
  }
  if (session != nullptr) {
    if (handle(barrier, *session, kind, commands)) Connections::refund(connection, charge);
  } else if (kind == InboxKind::hello) {
    handle_hello(barrier, id, received.access, received.bytes, commands);
  } else {
    answer_fault(
        barrier, id, nullptr,
        make_fault(ErrorCode::out_of_state, {}, "The first message of a session must be Hello."));
  }
  halt_if_paused(barrier);
}

bool can_hear(const Barrier& barrier, const Call& call) {
  return barrier.sessions.find(SessionId{call.session}) != nullptr;
}

void answer(Barrier& barrier, const Call& call, const std::function<void(wire::Outbox&)>& write) {
  Session* session = barrier.sessions.find(SessionId{call.session});
  if (session == nullptr) return;
  barrier.calls.answered(call);
  write(barrier.outbox);
  if (send(barrier, *session) == Delivery::unreachable) {
    lose(barrier, *session, "its connection is gone");
  }
}

}  // namespace ziggurat::network
