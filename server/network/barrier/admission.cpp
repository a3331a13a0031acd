// SPDX-License-Identifier: MIT
#include "network/barrier/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/exchange.h"
#include "network/barrier/hello_checks.h"
#include "network/barrier/peer_messages.h"
#include "network/barrier/timeouts.h"
#include "wire/command_limits.h"
#include "wire/direction.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;

namespace {

constexpr std::size_t max_label = 64;  // bytes of a client's name, and of its version
constexpr std::size_t max_waiting_bytes = std::size_t{64} << 20;  // of all Hellos that wait

/// Name of the client for a line on a terminal.
std::string label_of(const wire::Hello& hello) {
  std::string text = hello.client_name.substr(0, max_label);
  if (text.empty()) text = "unnamed client";
  if (!hello.client_version.empty()) text += " " + hello.client_version.substr(0, max_label);
  return printable(text);
}

std::string new_token() {
  std::random_device source;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", source());
  return token;
}

using Granted = std::variant<Session*, wire::Refusal>;

/// A session of a supervisor or observer.
Granted begin_without_robots(Barrier& barrier, const wire::Hello& hello) {
  const bool asks = !hello.robots.empty() || !hello.controller.empty() || hello.lua_only ||
                    !hello.session_token.empty();
  if (asks) {
    return make_refusal(ErrorCode::bad_value, "robots",
                        "A supervisor or observer asks for no robots and resumes no session.");
  }
  return &barrier.sessions.add();
}

/// A new session with all robots that the Hello asks for.
Granted begin_with_robots(Barrier& barrier, const wire::Hello& hello, const Access& access) {
  auto granted = grant_robots(barrier, hello, access);
  if (auto* refusal = std::get_if<wire::Refusal>(&granted)) return std::move(*refusal);
  const auto& robots = std::get<std::vector<std::size_t>>(granted);
  Session& session = barrier.sessions.add();
  session.token = new_token();
  session.roster = wire::make_roster(barrier.run->layout, robots);
  take_over(barrier, robots, label_of(hello));
  for (const std::size_t robot : robots) {
    barrier.ownership.take(robot, session.id, barrier.now);
    barrier.deadlines.clear_zero(robot);
  }
  return &session;
}

/// The session that has the Hello's token. Its older connection, if it still has one, is displaced.
Granted resume_session(Barrier& barrier, const wire::Hello& hello, const Access& access) {
  Session* session = barrier.sessions.with_token(hello.session_token);
  if (session == nullptr || session->role != hello.role) {
    return make_refusal(ErrorCode::no_such_session, "session_token",
                        "No session of this run has that token, or none any more.");
  }
  if (session->key != access.key) {
    return make_refusal(ErrorCode::forbidden, "session_token",
                        "The session was begun with another key, and only that one resumes it.");
  }
  std::vector<std::size_t> robots;
  for (std::size_t i = 0; i < session->roster.robots.size(); ++i) {
    if (!session->roster.gone[i]) robots.push_back(session->roster.robots[i]);
  }
  if (auto refusal = check_policy(barrier, hello, robots)) return std::move(*refusal);
  if (!session->director) {
    if (auto refusal = check_power(barrier, hello, access, robots)) return std::move(*refusal);
  } else {
    if (auto refusal = check_subscription(hello)) return std::move(*refusal);
    if (auto refusal = check_fixed(barrier, *session->director, hello)) return std::move(*refusal);
  }
  if (session->state != SessionState::lost) {
    barrier.outbox.displaced(label_of(hello), "The session was taken up over another connection.");
    send(barrier, *session);
    lose(barrier, *session, "it was taken up over another connection");
  }
  for (const std::size_t robot : robots) {
    barrier.ownership.take(robot, session->id, barrier.now);
    barrier.deadlines.clear_zero(robot);
  }
  return session;
}

/// A new session of a director.
Granted start_directing(Barrier& barrier, const wire::Hello& hello, const Access& access) {
  if (auto refusal = check_takeover(barrier, hello, access)) return std::move(*refusal);
  auto begun = begin_directing(barrier, hello, label_of(hello));
  if (auto* refusal = std::get_if<wire::Refusal>(&begun)) return std::move(*refusal);
  Session& session = *std::get<Session*>(begun);
  session.token = new_token();
  return &session;
}

Granted begin(Barrier& barrier, const wire::Hello& hello, const Access& access) {
  if (auto refusal = check_hello(barrier, hello, access.roles)) return std::move(*refusal);
  const bool has_ticks = hello.role == wire::Role::controller || hello.role == wire::Role::director;
  if (!has_ticks) return begin_without_robots(barrier, hello);
  if (!hello.session_token.empty()) return resume_session(barrier, hello, access);
  if (hello.role == wire::Role::director) return start_directing(barrier, hello, access);
  return begin_with_robots(barrier, hello, access);
}

/// Binds the session to its connection.
void bind(Barrier& barrier, Session& session, const std::string& connection) {
  session.connection = connection;
  if (session.role == wire::Role::controller && barrier.run) {
    session.command_limits = wire::command_limits(session.roster, barrier.run->layout,
                                                  barrier.connections.find(connection)->encoding);
  }
  if (session.role == wire::Role::director)
    session.command_limits = {wire::longest_direction, wire::most_fields};
  if (barrier.on_standing) {
    barrier.on_standing(connection, standing_of(&session), longest_message(barrier, &session));
  }
  session.liveness = {barrier.now, barrier.now, 0, 0};
  barrier.connections.bind(connection, session.id);
}

/// Sets the deadline policies of the session's robots. A policy that a Hello asks for holds until
/// another session has the robot; otherwise the controller's policy holds.
void set_policies(Barrier& barrier, const Session& session, const wire::Hello& hello) {
  if (!hello.deadline && !hello.session_token.empty()) return;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    barrier.deadlines.set_policy(session.roster.robots[i], hello.deadline);
  }
}

/// Longest time that the current tick has waited for earlier sessions of these robots or this
/// director.
std::chrono::nanoseconds waited_before(const Barrier& barrier, const Session& session) {
  std::chrono::nanoseconds longest{0};
  if (session.director) longest = barrier.directors.ownership[*session.director].waited;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    longest = std::max(longest, barrier.ownership[session.roster.robots[i]].waited);
  }
  return longest;
}

/// @param is_resumed  the session was there before
/// @param commands    of the tick that is being collected; null: none is
bool welcome(Barrier& barrier, Session& session, bool is_resumed, const world::Commands* commands) {
  wire::Welcome welcome;
  welcome.token = session.token;
  welcome.minor = session.minor;
  welcome.role = session.role;
  welcome.wall_lease_ms = static_cast<std::uint32_t>(barrier.config.lease.count());
  welcome.max_message_bytes = longest_message(barrier, &session);
  welcome.wall_heartbeat_ms = static_cast<std::uint32_t>(barrier.config.heartbeat.count());
  for (const std::size_t robot : session.roster.robots) {
    welcome.deadlines.push_back(barrier.deadlines.policy(robot));
  }
  if (session.director) {
    welcome.director = &barrier.directors.all[*session.director];
    welcome.deadlines.push_back(barrier.directors.deadlines.policy(*session.director));
  }
  welcome.is_resumed = is_resumed && session.minor >= wire::minor_with_events;
  welcome.commands = !commands && barrier.begin.commands ? &*barrier.begin.commands : commands;
  barrier.outbox.welcome(*barrier.run, session.roster, welcome);
  return send(barrier, session) == Delivery::sent;
}

void refuse(Barrier& barrier, const std::string& connection, const wire::Hello& hello,
            wire::Refusal refusal) {
  refusal.fault.severity = wire::Severity::fatal;
  refusal.fault.tick = tick_of(barrier);
  refusal.client_version = hello.version;
  barrier.outbox.refusal(refusal);
  send(barrier, connection);
  note(barrier, nullptr,
       fmt::format("{} was refused with {}: {}", label_of(hello), to_string(refusal.fault.code),
                   refusal.fault.message));
}

void admit(Barrier& barrier, const std::string& connection, const Access& access,
           const world::Commands* commands) {
  const wire::Hello hello = barrier.inbox.hello();
  auto granted = begin(barrier, hello, access);
  if (auto* refusal = std::get_if<wire::Refusal>(&granted)) {
    return refuse(barrier, connection, hello, std::move(*refusal));
  }
  Session& session = *std::get<Session*>(granted);
  session.role = hello.role;
  session.client = label_of(hello);
  session.minor = std::min(hello.version.minor, wire::version.minor);
  session.can_restore = hello.can_restore && session.minor >= wire::minor_with_epochs;
  session.state = SessionState::ready;
  session.key = access.key;
  bind(barrier, session, connection);
  if (session.director) take_director(barrier, session, hello);
  set_policies(barrier, session, hello);
  update_deadline(barrier, session);
  session.pending_answer.waited_before = waited_before(barrier, session);
  const bool is_welcomed = welcome(barrier, session, !hello.session_token.empty(), commands) &&
                           tell_taken(barrier, session, "Another client");
  const bool has_tick = barrier.gate.tick() && session.has_ticks();
  std::string_view why = is_welcomed ? "" : "its connection is gone";
  if (is_welcomed && has_tick) why = observe(barrier, session);
  session.pending_answer.is_resent = true;
  if (!why.empty()) lose(barrier, session, why);
}

Delivery tell_loading(Barrier& barrier, Session& session) {
  barrier.outbox.loading(barrier.progress.share, barrier.progress.message);
  return send(barrier, session);
}

/// Keeps the Hello until the world is loaded.
void keep_waiting(Barrier& barrier, const std::string& connection, const Access& access,
                  std::string_view bytes) {
  const wire::Hello hello = barrier.inbox.hello();
  // A role that its key does not have, which is refused later, takes no place of that role.
  const wire::Role role = access.roles.allow(hello.role) ? hello.role : wire::Role::observer;
  if (auto refusal = check_places(barrier, role)) {
    return refuse(barrier, connection, hello, std::move(*refusal));
  }
  if (barrier.sessions.waiting_bytes() + bytes.size() > max_waiting_bytes) {
    auto refusal = make_refusal(ErrorCode::too_many, {}, "Too many wait for the world already.");
    refusal.fault.retryable = true;
    return refuse(barrier, connection, hello, std::move(refusal));
  }
  Session& session = barrier.sessions.add();
  session.role = role;
  session.state = SessionState::hello;
  session.waiting_hello = {std::string(bytes), access};
  bind(barrier, session, connection);
  tell_loading(barrier, session);
}

}  // namespace

void handle_hello(Barrier& barrier, const std::string& connection, const Access& access,
                  std::string_view bytes, const world::Commands* commands) {
  if (!barrier.run) return keep_waiting(barrier, connection, access, bytes);
  admit(barrier, connection, access, commands);
}

void admit_waiting(Barrier& barrier) {
  std::vector<std::pair<std::string, WaitingHello>> waiting;
  barrier.sessions.for_each([&](Session& session) {
    // A client whose connection is gone gets no session and no lease.
    if (tell_loading(barrier, session) != Delivery::unreachable) {
      waiting.emplace_back(session.connection, std::move(session.waiting_hello));
    }
    erase(barrier, session);
  });
  for (const auto& [connection, application] : waiting) {
    barrier.inbox.parse(application.hello);
    admit(barrier, connection, application.access, nullptr);
  }
}

}  // namespace ziggurat::network
