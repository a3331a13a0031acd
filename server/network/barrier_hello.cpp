// How sessions begin.

#include <fmt/format.h>

#include <random>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

namespace {

constexpr std::size_t max_label = 64;  // bytes of a client's name, and of its version

/// What a peer calls itself, fit for a line on a terminal.
std::string label(const wire::Hello& hello) {
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

wire::Refusal refusal(ErrorCode code, std::string field, std::string message) {
  return {make_fault(code, std::move(field), std::move(message)), {}, {}};
}

}  // namespace

void Barrier::say_hello(const std::string& peer) {
  const wire::Hello hello = inbox_.hello();
  if (auto refused = check_hello(hello)) return refuse(peer, hello, std::move(*refused));
  auto taken = hello.session_token.empty() ? take_robots(hello) : resume(hello);
  if (auto* refused = std::get_if<wire::Refusal>(&taken)) {
    return refuse(peer, hello, std::move(*refused));
  }
  Session& session = *std::get<Session*>(taken);
  session.peer = peer;
  session.encoding = stranger_;
  session.client = label(hello);
  session.minor = std::min(hello.version.minor, wire::version.minor);
  session.state = SessionState::ready;
  session.faults = 0;
  session.last_message = std::chrono::steady_clock::now();
  by_peer_[peer] = &session;
  outbox_.welcome(run_, session.roster, session.token, session.minor);
  const bool is_welcomed = send_(peer, outbox_) == Delivery::sent;
  // Who comes late gets the tick that the others are at.
  const bool is_there = is_welcomed && (!observations_ || observe(session));
  if (!is_there) lose(session, "its connection is gone");
}

std::optional<wire::Refusal> Barrier::check_hello(const wire::Hello& hello) const {
  if (hello.version.major != wire::version.major) {
    return refusal(ErrorCode::version_mismatch, "version",
                   fmt::format("The client speaks version {}.{} of the protocol, the server {}.{}.",
                               hello.version.major, hello.version.minor, wire::version.major,
                               wire::version.minor));
  }
  if (hello.role == wire::Role::supervisor || hello.role == wire::Role::observer) {
    return refusal(ErrorCode::unimplemented, "role", "This server knows the role CONTROLLER only.");
  }
  if (hello.role != wire::Role::controller) {
    return refusal(ErrorCode::bad_value, "role", "A Hello names its role.");
  }
  if (hello.deadline_action != wire::DeadlineAction::unspecified &&
      hello.deadline_action != wire::DeadlineAction::wait) {
    return refusal(ErrorCode::unimplemented, "deadline_policy",
                   "This server knows the deadline policy WAIT only.");
  }
  if (finished_) return refusal(ErrorCode::out_of_state, {}, "The run is over.");
  if (sessions_.size() >= config_.max_sessions) {
    auto refused =
        refusal(ErrorCode::too_many, {},
                fmt::format("The server has {} sessions and takes no more.", sessions_.size()));
    refused.fault.retryable = true;
    return refused;
  }
  return std::nullopt;
}

/// Why a robot can't be taken, if it can't.
std::optional<wire::Refusal> Barrier::check_seat(std::size_t robot) {
  const std::string& id = run_.layout.robots[robot].id;
  if (seats_[robot].gone) {
    auto refused = refusal(ErrorCode::not_yours, "robots",
                           fmt::format("Robot '{}' has left the run for good.", id));
    refused.fault.robot = id;
    return refused;
  }
  if (seats_[robot].holder == nullptr || !is_reachable(*seats_[robot].holder)) return std::nullopt;
  auto refused =
      refusal(ErrorCode::robot_taken, "robots",
              fmt::format("Robot '{}' is driven by {}.", id, seats_[robot].holder->client));
  refused.fault.robot = id;
  refused.fault.retryable = true;
  refused.holder = seats_[robot].holder->client;
  return refused;
}

/// A new session with all robots that the Hello asks for, or none.
std::variant<Session*, wire::Refusal> Barrier::take_robots(const wire::Hello& hello) {
  auto selection = select_robots(hello, run_);
  if (auto* fault = std::get_if<wire::Fault>(&selection)) {
    return wire::Refusal{std::move(*fault), {}, {}};
  }
  std::vector<std::size_t> robots;
  for (const Selected& selected : std::get<std::vector<Selected>>(selection)) {
    if (seats_[selected.robot].gone && !selected.by_id) continue;
    if (auto refused = check_seat(selected.robot)) return std::move(*refused);
    robots.push_back(selected.robot);
  }
  if (robots.empty()) {
    return refusal(ErrorCode::not_yours, "robots", "All robots asked for have left the run.");
  }
  auto session = std::make_unique<Session>();
  session->token = new_token();
  session->roster = wire::make_roster(run_.layout, robots);
  for (const std::size_t robot : robots) {
    seats_[robot].holder = session.get();
    --free_;
  }
  sessions_.push_back(std::move(session));
  return sessions_.back().get();
}

/// The session that the Hello's token is for, unless it is alive or others have its robots.
std::variant<Session*, wire::Refusal> Barrier::resume(const wire::Hello& hello) {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& session) {
    return session->token == hello.session_token;
  });
  if (found == sessions_.end()) {
    return refusal(ErrorCode::no_such_session, "session_token",
                   "No session of this run has that token.");
  }
  Session& session = **found;
  if (is_reachable(session)) {
    auto refused = refusal(ErrorCode::robot_taken, "session_token", "That session is connected.");
    refused.holder = session.client;
    return refused;
  }
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    if (auto refused = check_seat(session.roster.robots[i])) return std::move(*refused);
  }
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    seats_[session.roster.robots[i]].holder = &session;
    --free_;
  }
  return &session;
}

/// Asks the connection itself; a session without is lost from then on.
bool Barrier::is_reachable(Session& session) {
  if (session.state == SessionState::lost) return false;
  outbox_.heartbeat(++heartbeats_);
  if (send_(session.peer, outbox_) != Delivery::unreachable) return true;
  lose(session, "its connection is gone");
  return false;
}

void Barrier::refuse(const std::string& peer, const wire::Hello& hello, wire::Refusal refused) {
  refused.fault.severity = wire::Severity::fatal;
  refused.fault.tick = observations_ ? observations_->tick : 0;
  refused.client_version = hello.version;
  outbox_.refusal(refused);
  send_(peer, outbox_);
  note(fmt::format("{} was refused with {}: {}", label(hello), to_string(refused.fault.code),
                   refused.fault.message));
}

}  // namespace ziggurat::network
