// SPDX-License-Identifier: MIT
#include "network/barrier/directing.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "network/barrier/answer_timing.h"
#include "network/barrier/departure.h"
#include "network/barrier/exchange.h"
#include "network/barrier/hello_checks.h"
#include "network/barrier/peer_messages.h"
#include "network/barrier/timeouts.h"
#include "network/glob.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

namespace {

constexpr std::size_t longest_id = 64;     // of a director from outside [bytes]
constexpr std::size_t most_in_a_run = 64;  // those that have left included: their metrics are kept

wire::Refusal refuse(ErrorCode code, std::string field, std::string message) {
  return make_refusal(code, std::move(field), std::move(message));
}

bool is_id(std::string_view text) {
  return !text.empty() && text.size() <= longest_id && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  });
}

/// View of a director that has not been sent anything of the world yet.
wire::WorldView view_of(wire::Subscription subscription) {
  wire::WorldView view;
  view.subscription = std::move(subscription);
  return view;
}

/// Checks the fields of a director's Hello, also for a director that the scene does not name.
std::optional<wire::Refusal> check_director_hello(const Barrier& barrier,
                                                  const wire::Hello& hello) {
  if (!hello.robots.empty() || !hello.controller.empty() || hello.lua_only) {
    return refuse(ErrorCode::bad_value, "robots", "A director asks for no robots.");
  }
  if (hello.director.empty()) {
    return refuse(ErrorCode::bad_value, "director", "A Hello of a director says which it is.");
  }
  if (auto refusal = check_subscription(hello)) return refusal;
  return check_policy(barrier, hello, {});
}

/// The director of that id; one from outside, if these are allowed, is a new one, behind all
/// others.
std::variant<std::size_t, wire::Refusal> find_director(const Barrier& barrier,
                                                       const std::string& id) {
  const Directors& directors = barrier.directors;
  if (const auto found = directors.find(id)) return *found;
  const std::string shown = id.substr(0, longest_id);
  if (!directors.are_allowed) {
    return refuse(
        ErrorCode::forbidden, "director",
        fmt::format("The scene has no director '{}', and --allow-director was not given.", shown));
  }
  if (!is_id(id)) {
    return refuse(ErrorCode::bad_value, "director",
                  fmt::format("The id of a director must have 1 to {} letters, digits, '_', '-' or "
                              "'.'.",
                              longest_id));
  }
  const auto& entities = barrier.run->layout.entities;
  if (std::ranges::find(entities, id, &world::EntityLayout::id) != entities.end()) {
    return refuse(ErrorCode::bad_value, "director",
                  fmt::format("An entity has the id '{}'; a director has one of its own.", shown));
  }
  std::size_t present = 0;
  for (std::size_t i = 0; i < directors.all.size(); ++i)
    present += directors.ownership[i].has_left ? 0 : 1;
  if (present >= scene::Director::most || directors.all.size() >= most_in_a_run) {
    auto refusal =
        refuse(ErrorCode::too_many, "director",
               fmt::format("The world has {} directors, and has had {}; it takes no more.", present,
                           directors.all.size()));
    refusal.fault.retryable = directors.all.size() < most_in_a_run;
    return refusal;
  }
  return directors.all.size();
}

/// Adds the number of the last director.
void sort_last(Directors& directors) {
  const std::size_t last = directors.all.size() - 1;
  const auto id = [&](std::size_t each) -> const std::string& { return directors.all[each].id; };
  directors.by_id.insert(std::ranges::lower_bound(directors.by_id, id(last), {}, id), last);
}

void add_from_outside(Barrier& barrier, const std::string& id) {
  Directors& directors = barrier.directors;
  directors.all.emplace_back().id = id;
  directors.answers.emplace_back();
  directors.ownership.add(barrier.now, InTick::skipped);
  directors.deadlines.grow(directors.deadline_of_others);
  sort_last(directors);
}

std::optional<wire::Refusal> check_seat(Barrier& barrier, std::size_t director, bool is_takeover) {
  const std::string& id = barrier.directors.all[director].id;
  const Ownership::Entry& entry = barrier.directors.ownership[director];
  if (entry.has_left) {
    return refuse(ErrorCode::not_yours, "director",
                  fmt::format("The director '{}' has left the run for good.", id));
  }
  if (is_takeover) return std::nullopt;
  Session* holder = barrier.sessions.find(entry.holder);
  const bool is_held = holder != nullptr && is_reachable(barrier, *holder);
  const Session* claimant = barrier.sessions.find(entry.claimant);
  const bool is_kept = claimant != nullptr && barrier.now < claimant->lease_end;
  if (!is_held && !is_kept) return std::nullopt;
  auto refusal = refuse(ErrorCode::robot_taken, "director",
                        is_held ? fmt::format("The director '{}' is {}.", id, holder->client)
                                : fmt::format("The director '{}' is kept for {}, which is lost.",
                                              id, claimant->client));
  refusal.fault.retryable = true;
  refusal.holder = is_held ? holder->client : claimant->client;
  return refusal;
}

/// The sessions that have the director, or may resume it, lose it to another client.
void displace(Barrier& barrier, std::size_t director, const std::string& by) {
  const Ownership::Entry& entry = barrier.directors.ownership[director];
  Session* session = barrier.sessions.find(entry.owner());
  if (session == nullptr) return;
  if (session->state != SessionState::lost) {
    barrier.outbox.displaced(
        by, fmt::format("{} is director '{}' now.", by, barrier.directors.all[director].id));
    send(barrier, *session);
  }
  erase(barrier, *session);
}

/// Extends the view of a director by new entities that its subscription matches.
void update_view(wire::WorldView& view, const wire::Truth& truth) {
  if (view.considered == truth.layout.entities.size()) return;
  const auto& patterns = view.subscription.entities;
  std::vector<Glob> globs;
  for (const std::string& pattern : patterns) {
    if (has_wildcards(pattern)) globs.emplace_back(pattern);
  }
  for (std::size_t i = view.considered; i < truth.layout.entities.size(); ++i) {
    const std::string& id = truth.layout.entities[i].id;
    const bool is_wanted =
        patterns.empty() || std::ranges::find(patterns, id) != patterns.end() ||
        std::ranges::any_of(globs, [&](const Glob& glob) { return glob.matches(id); });
    consider(view, truth, i, is_wanted && !truth.state.is_absent(i));
  }
}

void keep_words(Barrier& barrier, std::size_t director, std::vector<wire::LogLine> lines) {
  for (wire::LogLine& line : lines) {
    barrier.journal.log_of_directors().push_back(
        {barrier.directors.all[director].id, line.error, std::move(line.text)});
  }
}

/// Metrics of a director, with its number in place of a robot's.
std::vector<wire::Metric> numbered(std::vector<wire::Metric> metrics, std::size_t director) {
  for (wire::Metric& metric : metrics) metric.robot = director;
  return metrics;
}

std::optional<wire::Fault> check(const Barrier& barrier, const Session& session,
                                 bool is_collecting) {
  if (!session.director || session.state == SessionState::ready) {
    return make_fault(ErrorCode::out_of_state, {},
                      "A Direction answers a WorldState; none was sent.");
  }
  if (auto fault = check_epoch(session.pending_answer, barrier.inbox.command_epoch())) return fault;
  if (auto fault = check_tick(session.pending_answer, barrier.inbox.command_tick())) return fault;
  if (!is_collecting) {
    return make_fault(ErrorCode::out_of_state, {}, "No tick is being collected.");
  }
  return barrier.inbox.check_direction();
}

/// Checks a Direction against metrics and world.
std::optional<wire::Fault> check(const Barrier& barrier, const Session& session,
                                 const wire::Direction& direction) {
  auto fault = barrier.directors.metrics.check(numbered(direction.metrics, *session.director));
  if (fault || !barrier.directors.check) return fault;
  return barrier.directors.check(direction);
}

std::string_view tell_view_too_large(Barrier& barrier, const Session& session) {
  tell_fatal(
      barrier, session.connection,
      make_fault(
          ErrorCode::too_large, "subscription",
          "What this director subscribed to is more than a message can hold; name fewer entities "
          "or groups."));
  return "what it subscribed to is more than a message can hold";
}

void answer_bad_direction(Barrier& barrier, Session& session, wire::Fault fault) {
  if (take_stale_reason(session.pending_answer, fault.code) == StaleReason::none) {
    return answer_fault(barrier, session.connection, &session, std::move(fault));
  }
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  send(barrier, session);
}

}  // namespace

void add_directors(Barrier& barrier, const std::vector<Config::Deadline>& deadlines) {
  Directors& directors = barrier.directors;
  const std::size_t controllers = barrier.run->controllers.size();
  for (const scene::Director& director : barrier.run->directors) {
    const std::size_t given = controllers + directors.all.size();
    directors.deadlines.grow(
        given < deadlines.size()
            ? deadlines[given]
            : Config::Deadline{director.deadline.value_or(scene::DeadlinePolicy{}), false});
    directors.all.push_back(director);
    directors.answers.emplace_back();
    directors.ownership.add(barrier.now, InTick::awaited);
    sort_last(directors);
  }
}

std::optional<wire::Refusal> check_subscription(const wire::Hello& hello) {
  if (!hello.subscription) return std::nullopt;
  const auto& patterns = hello.subscription->entities;
  const auto is_long = [](const std::string& text) { return text.size() > longest_pattern; };
  if (patterns.size() <= most_patterns && std::ranges::none_of(patterns, is_long))
    return std::nullopt;
  return refuse(ErrorCode::too_many, "subscription.entities",
                fmt::format("A subscription may have {} patterns of {} bytes at most.",
                            most_patterns, longest_pattern));
}

std::optional<wire::Refusal> check_fixed(const Barrier& barrier, std::size_t director,
                                         const wire::Hello& hello) {
  const Directors& directors = barrier.directors;
  if (!hello.deadline) return std::nullopt;
  const bool is_new = director == directors.all.size();
  const auto fixed = is_new ? fixed_against(directors.deadline_of_others, *hello.deadline)
                            : directors.deadlines.fixed_against(director, *hello.deadline);
  if (!fixed) return std::nullopt;
  return refuse(ErrorCode::forbidden, "deadline_policy",
                fmt::format("The deadline policy of directors is fixed: {}.", to_text(*fixed)));
}

std::variant<Session*, wire::Refusal> begin_directing(Barrier& barrier, const wire::Hello& hello,
                                                      const std::string& client) {
  if (auto refusal = check_director_hello(barrier, hello)) return std::move(*refusal);
  auto found = find_director(barrier, hello.director);
  if (auto* refusal = std::get_if<wire::Refusal>(&found)) return std::move(*refusal);
  const std::size_t director = std::get<std::size_t>(found);
  if (auto refusal = check_fixed(barrier, director, hello)) return std::move(*refusal);
  if (director == barrier.directors.all.size()) {
    add_from_outside(barrier, hello.director);
  } else {
    if (auto refusal = check_seat(barrier, director, hello.takeover)) return std::move(*refusal);
    displace(barrier, director, client);
  }
  Session& session = barrier.sessions.add();
  session.director = director;
  return &session;
}

void take_director(Barrier& barrier, Session& session, const wire::Hello& hello) {
  wire::Subscription subscription = hello.subscription.value_or(session.view.subscription);
  const bool is_of_none = !hello.subscription && hello.session_token.empty();
  session.view = view_of(std::move(subscription));
  if (is_of_none) session.view.subscription.entities = {std::string()};  // no entity has that id
  barrier.directors.ownership.take(*session.director, session.id, barrier.now);
  if (hello.deadline || hello.session_token.empty()) {
    barrier.directors.deadlines.set_policy(*session.director, hello.deadline);
  }
}

void release_director(Barrier& barrier, Session& session, Claim claim) {
  if (!session.director) return;
  Ownership& ownership = barrier.directors.ownership;
  if (ownership[*session.director].holder != session.id) {
    if (claim == Claim::dropped && ownership[*session.director].claimant == session.id) {
      ownership.drop_claim(*session.director);
    }
    return;
  }
  const bool is_skipped = barrier.gate.has_missed(session.pending_answer);
  const Time since = is_skipped ? session.pending_answer.waiting_since : barrier.now;
  ownership.release(*session.director, claim == Claim::kept ? session.id : SessionId::none, since,
                    is_skipped ? InTick::skipped : InTick::awaited,
                    barrier.gate.waited(session.pending_answer, barrier.now));
  if (!is_skipped) check_soon(barrier);
}

void remove_director(Barrier& barrier, Session& session) {
  if (!session.director) return;
  barrier.directors.ownership.leave(*session.director);
  session.director.reset();
}

std::string_view show_world(Barrier& barrier, Session& session) {
  const Connection* connection = barrier.connections.find(session.connection);
  const bool is_json = connection->encoding == wire::Encoding::json;
  const std::size_t limit =
      is_json ? wire::max_json_observation_bytes : wire::max_observation_bytes;
  session.pending_answer.epoch = barrier.epoch;
  session.state = SessionState::stepping;
  barrier.gate.await(session.pending_answer, barrier.now);
  expect_answer(barrier, session);
  if (!barrier.directors.truth) return {};
  const wire::Truth& truth = *barrier.directors.truth;
  update_view(session.view, truth);
  if (has_news(session.view, truth.state)) {
    if (!world_layout(barrier.outbox, *barrier.run, truth, session.view, limit)) {
      return tell_view_too_large(barrier, session);
    }
    const Delivery told = send(barrier, session);
    if (told != Delivery::sent) {  // all of it is told with the next tick
      session.view = view_of(std::move(session.view.subscription));
      return lost_by(told, session);
    }
  }
  if (!world_state(session.observation, truth, session.view, limit, barrier.epoch)) {
    return tell_view_too_large(barrier, session);
  }
  session.liveness.last_sent = barrier.now;
  session.observation.encode(connection->encoding);
  const Delivery delivery = barrier.send(session.connection, session.observation);
  return lost_by(delivery, session);
}

bool handle_direction(Barrier& barrier, Session& session, bool is_collecting) {
  if (session.state == SessionState::draining) {
    if (session.director && !barrier.inbox.check_direction()) {
      keep_words(barrier, *session.director, barrier.inbox.direction().log);
    }
    return false;
  }
  if (auto fault = check(barrier, session, is_collecting)) {
    answer_bad_direction(barrier, session, std::move(*fault));
    return false;
  }
  wire::Direction direction = barrier.inbox.direction();
  if (auto fault = check(barrier, session, direction)) {
    answer_bad_direction(barrier, session, std::move(*fault));
    return false;
  }
  session.liveness.faults = 0;
  session.pending_answer.late_commands = session.pending_answer.stale_commands = 0;
  barrier.directors.deadlines.forgive(*session.director);
  barrier.directors.metrics.set(numbered(direction.metrics, *session.director));
  keep_words(barrier, *session.director, std::move(direction.log));
  barrier.directors.answers[*session.director] = std::move(direction);
  barrier.gate.settle(session.pending_answer, barrier.now);
  measure_answer(barrier, session);
  return true;
}

void leave_directing(Barrier& barrier, Session& session) {
  auto fault = barrier.inbox.check_direction();
  if (!fault && session.director) {
    fault = barrier.directors.metrics.check(
        numbered(barrier.inbox.direction().metrics, *session.director));
  }
  if (fault) return answer_fault(barrier, session.connection, &session, std::move(*fault));
  if (session.director) {
    wire::Direction last = barrier.inbox.direction();
    keep_words(barrier, *session.director, std::move(last.log));
    barrier.directors.metrics.set(numbered(std::move(last.metrics), *session.director));
    const wire::Leave leave = barrier.inbox.leave();
    if (leave.reason == wire::LeaveReason::failed) {
      barrier.journal.fail(barrier.directors.all[*session.director].id, leave.message,
                           session.pending_answer.tick);
    }
    remove_director(barrier, session);
  }
  erase(barrier, session);
}

void forget_directions(Barrier& barrier) {
  Directors& directors = barrier.directors;
  for (auto& answer : directors.answers) answer.reset();
  directors.metrics.clear();
  directors.deadlines.reset();
  directors.truth.reset();
  barrier.sessions.for_each(
      [](Session& session) { session.view = view_of(std::move(session.view.subscription)); });
}

const std::vector<Directed>& directions(Barrier& barrier) {
  Directors& directors = barrier.directors;
  directors.directed.clear();
  for (const std::size_t director : directors.by_id) {
    const auto& answer = directors.answers[director];
    if (answer) directors.directed.push_back({directors.all[director].id, *answer});
  }
  return directors.directed;
}

bool wants_contacts(const Barrier& barrier) {
  const Directors& directors = barrier.directors;
  for (std::size_t i = 0; i < directors.all.size(); ++i) {
    const Ownership::Entry& entry = directors.ownership[i];
    const Session* session = barrier.sessions.find(entry.owner());
    if (session != nullptr && session->view.subscription.contacts) return true;
  }
  return false;
}

void warn_director(Barrier& barrier, const std::string& director, wire::Fault fault) {
  const auto number = barrier.directors.find(director);
  if (!number) return;
  Session* session = barrier.sessions.find(barrier.directors.ownership[*number].holder);
  if (session == nullptr) return;
  fault.severity = wire::Severity::warning;
  fault.tick = tick_of(barrier);
  barrier.outbox.error(fault);
  if (send(barrier, *session) != Delivery::unreachable) return;
  lose(barrier, *session, "its connection is gone");
}

}  // namespace ziggurat::network
