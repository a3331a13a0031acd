// Sessions without robots: what they ask for is for the server's owner to do.

#include <fmt/format.h>

#include <algorithm>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using Kind = wire::Request::Kind;

namespace {

constexpr std::size_t most_unanswered = 64;  // requests of a session

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

/// A session of a supervisor or observer.
std::variant<Session*, wire::Refusal> Barrier::take_none(const wire::Hello& hello) {
  const bool asks = !hello.robots.empty() || !hello.controller.empty() || hello.lua_only ||
                    !hello.session_token.empty();
  if (asks) {
    return wire::Refusal{make_fault(ErrorCode::bad_value, "robots",
                                    "A supervisor or observer asks for no robots and resumes "
                                    "no session."),
                         {},
                         {}};
  }
  sessions_.push_back(std::make_unique<Session>());
  sessions_.back()->role = hello.role;
  return sessions_.back().get();
}

void Barrier::say_request(Session& session) {
  const std::uint64_t id = inbox_.request_id();
  wire::Request request = inbox_.request();
  const bool only_looks = request.kind == Kind::status || request.kind == Kind::read;
  const bool may = session.role == wire::Role::supervisor ||
                   (session.role == wire::Role::observer && only_looks);
  std::optional<wire::Fault> fault;
  if (request.kind == Kind::none) {
    fault = make_fault(ErrorCode::bad_value, "request", "Nothing is asked for.");
  } else if (!may) {
    fault = make_fault(ErrorCode::forbidden, {}, "This role may not ask for that.");
  } else if (request.kind == Kind::snapshot || request.kind == Kind::restore) {
    fault = make_fault(ErrorCode::unimplemented, {}, "There are no snapshots yet.");
  } else if (session.unanswered >= most_unanswered) {
    fault = make_fault(ErrorCode::too_many, {},
                       fmt::format("{} requests are unanswered.", session.unanswered));
  }
  if (fault) return fail(session.peer, &session, std::move(*fault), id);
  session.faults = 0;
  ++session.unanswered;
  calls_.push_back({session.peer, std::move(request)});
}

std::vector<Call> Barrier::take_calls() {
  has_stood_ = false;
  return std::exchange(calls_, {});
}

bool Barrier::can_hear(const Call& call) const {
  const auto found = peers_.find(call.peer);
  return found != peers_.end() && found->second.session != nullptr;
}

void Barrier::answer(const Call& call, const std::function<void(wire::Outbox&)>& write) {
  const auto found = peers_.find(call.peer);
  if (found == peers_.end() || found->second.session == nullptr) return;
  Session& session = *found->second.session;
  if (session.unanswered > 0) --session.unanswered;
  write(outbox_);
  if (deliver(session, outbox_) == Delivery::unreachable) lose(session, "its connection is gone");
}

void Barrier::reset(std::uint64_t seed) {
  run_.seed = seed;
  forget_robots();
  observations_.reset();  // whoever comes now gets no tick of the world that was
  for (Seat& seat : seats_) {
    seat.misses_in_row = 0;
    seat.zeroed = false;
  }
  outbox_.reset(seed);
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    settle(*session);
    const bool is_there =
        session->state == SessionState::stepping || session->state == SessionState::paused;
    if (!is_there || session->roster.empty()) continue;
    session->late_commands = 0;
    if (deliver(*session, outbox_) == Delivery::unreachable) gone.push_back(session.get());
  }
  for (Session* session : gone) lose(*session, "its connection is gone");
}

wire::SessionStatus Barrier::status_of(const Session& session) const {
  using State = wire::SessionStatus::State;
  wire::SessionStatus status;
  status.client = session.client;
  status.role = session.role;
  status.tick = session.tick;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    const std::size_t robot = session.roster.robots[i];
    status.robots.push_back(run_.layout.robots[robot].id);
    status.deadline = seats_[robot].deadline;
  }
  switch (session.state) {
    case SessionState::ready:
      status.state = State::ready;
      break;
    case SessionState::stepping:
      status.state = session.owes ? State::owing : State::answered;
      break;
    case SessionState::paused:
      status.state = State::paused;
      break;
    case SessionState::draining:
      status.state = State::draining;
      break;
    case SessionState::lost:
      status.state = State::lost;
      break;
  }
  const Clock::time_point now = Clock::now();
  if (session.owes) status.wall_waiting_s = seconds(now - session.owes_since);
  if (session.state == SessionState::lost && !session.roster.empty()) {
    status.wall_waiting_s = seconds(now - seats_[session.roster.robots.front()].free_since);
  }
  status.wall_last_message_s = seconds(now - session.last_message);
  status.latency = session.latencies.recent();
  status.misses = session.misses;
  return status;
}

void Barrier::fill(wire::Status& status) const {
  for (const auto& session : sessions_) status.sessions.push_back(status_of(*session));
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    const Seat& seat = seats_[i];
    if (seat.gone) status.gone_robots.push_back(run_.layout.robots[i].id);
    if (!seat.gone && seat.holder == nullptr && seat.claimant == nullptr) {
      status.free_robots.push_back(run_.layout.robots[i].id);
    }
  }
}

}  // namespace ziggurat::network
