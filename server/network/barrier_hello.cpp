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

void Barrier::say_hello(const std::string& peer, const Roles& roles) {
  const wire::Hello hello = inbox_.hello();
  if (auto refused = check_hello(hello, roles)) return refuse(peer, hello, std::move(*refused));
  const bool is_controller = hello.role == wire::Role::controller;
  auto taken = !is_controller                ? take_none(hello)
               : hello.session_token.empty() ? take_robots(hello)
                                             : resume(hello);
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
  session.heartbeats = 0;
  session.last_message = now_;
  peers_.at(peer).session = &session;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i]) continue;
    const std::size_t robot = session.roster.robots[i];
    if (hello.deadline) {
      seats_[robot].deadline = *hello.deadline;
    } else if (hello.session_token.empty()) {
      seats_[robot].deadline = policy_of(robot);
    }
  }
  set_patience(session);
  set_paths(session);
  const bool is_welcomed = welcome(session);
  // Who comes late gets the tick that the others are at.
  const bool is_there =
      is_welcomed && (!observations_ || session.roster.empty() || observe(session));
  session.is_repeated = true;
  if (!is_there) lose(session, "its connection is gone");
}

bool Barrier::welcome(Session& session) {
  wire::Welcome welcome;
  welcome.token = session.token;
  welcome.minor = session.minor;
  welcome.role = session.role;
  welcome.wall_lease_ms = static_cast<std::uint32_t>(config_.lease.count());
  welcome.wall_heartbeat_ms = static_cast<std::uint32_t>(config_.heartbeat.count());
  for (const std::size_t robot : session.roster.robots) {
    welcome.deadlines.push_back(seats_[robot].deadline);
  }
  outbox_.welcome(run_, session.roster, welcome);
  return deliver(session, outbox_) == Delivery::sent;
}

std::optional<wire::Refusal> Barrier::check_hello(const wire::Hello& hello,
                                                  const Roles& roles) const {
  if (hello.version.major != wire::version.major) {
    return refusal(ErrorCode::version_mismatch, "version",
                   fmt::format("The client speaks version {}.{} of the protocol, the server {}.{}.",
                               hello.version.major, hello.version.minor, wire::version.major,
                               wire::version.minor));
  }
  const bool is_role = hello.role == wire::Role::controller ||
                       hello.role == wire::Role::supervisor || hello.role == wire::Role::observer;
  if (is_role && !roles.allow(hello.role)) {
    return refusal(ErrorCode::forbidden, "role", "The key of this connection has another role.");
  }
  if (!is_role) {
    return refusal(ErrorCode::bad_value, "role", "A Hello names its role.");
  }
  if (is_finished_) return refusal(ErrorCode::out_of_state, {}, "The run is over.");
  const auto connected = static_cast<std::size_t>(std::ranges::count_if(
      sessions_, [](const auto& each) { return each->state != SessionState::lost; }));
  if (connected >= config_.max_sessions) {
    auto refused = refusal(ErrorCode::too_many, {},
                           fmt::format("The server has {} sessions and takes no more.", connected));
    refused.fault.retryable = true;
    return refused;
  }
  return std::nullopt;
}

/// Why the wish for a policy can't be granted, if it can't.
std::optional<wire::Refusal> Barrier::check_deadline(const wire::Hello& hello,
                                                     std::span<const std::size_t> robots) const {
  if (!hello.deadline) return std::nullopt;
  const auto& wish = *hello.deadline;
  const bool is_wait = wish.action == scene::DeadlineAction::wait;
  if (wish.action < scene::DeadlineAction::wait || wish.action > scene::DeadlineAction::stop) {
    return refusal(ErrorCode::bad_value, "deadline_policy.action",
                   "The deadline policy has no action that this protocol knows.");
  }
  if (!is_wait && wish.wall_deadline_ms == 0) {
    return refusal(ErrorCode::bad_value, "deadline_policy.wall_deadline_ms",
                   "A deadline policy other than WAIT has a deadline of at least 1 ms.");
  }
  for (const std::size_t robot : robots) {
    const std::size_t controller = run_.layout.robots[robot].controller;
    if (controller >= config_.deadlines.size()) continue;
    const Config::Deadline& deadline = config_.deadlines[controller];
    if (!deadline.is_fixed || deadline.policy == wish) continue;
    auto refused = refusal(ErrorCode::forbidden, "deadline_policy",
                           fmt::format("The deadline policy of controller '{}' is fixed: {}.",
                                       run_.controllers[controller].id, to_text(deadline.policy)));
    refused.fault.robot = run_.layout.robots[robot].id;
    return refused;
  }
  return std::nullopt;
}

/// Why a robot can't be taken, if it can't.
std::optional<wire::Refusal> Barrier::check_seat(std::size_t robot, bool is_takeover) {
  const std::string& id = run_.layout.robots[robot].id;
  const Seat& seat = seats_[robot];
  if (seat.gone) {
    auto refused = refusal(ErrorCode::not_yours, "robots",
                           fmt::format("Robot '{}' has left the run for good.", id));
    refused.fault.robot = id;
    return refused;
  }
  if (is_takeover) return std::nullopt;
  std::string message;
  if (seat.holder != nullptr && is_reachable(*seat.holder)) {
    message = fmt::format("Robot '{}' is driven by {}.", id, seat.holder->client);
  } else if (seat.claimant != nullptr && now_ < seat.claimant->lease_end) {
    const std::chrono::duration<double> rest = seat.claimant->lease_end - now_;
    message = fmt::format("Robot '{}' is kept for {}, which is lost, for {:.1f} s more.", id,
                          seat.claimant->client, rest.count());
  } else {
    return std::nullopt;
  }
  auto refused = refusal(ErrorCode::robot_taken, "robots", std::move(message));
  refused.fault.robot = id;
  refused.fault.retryable = true;
  refused.holder = (seat.holder != nullptr ? seat.holder : seat.claimant)->client;
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
    if (!seats_[selected.robot].gone || selected.by_id) robots.push_back(selected.robot);
  }
  if (robots.empty()) {
    return refusal(ErrorCode::not_yours, "robots", "All robots asked for have left the run.");
  }
  // What can never succeed comes before what may succeed later.
  if (auto refused = check_deadline(hello, robots)) return std::move(*refused);
  for (const std::size_t robot : robots) {
    if (auto refused = check_seat(robot, hello.takeover)) return std::move(*refused);
  }
  auto session = std::make_unique<Session>();
  session->token = new_token();
  session->roster = wire::make_roster(run_.layout, robots);
  for (const std::size_t robot : robots) {
    const Seat& seat = seats_[robot];
    if (seat.holder != nullptr) displace(*seat.holder, label(hello));
    if (seat.claimant != nullptr) erase(*seat.claimant);
    take_seat(robot, *session);
  }
  sessions_.push_back(std::move(session));
  return sessions_.back().get();
}

/// The session that has the Hello's token. Its older connection, if it still has one, is displaced.
std::variant<Session*, wire::Refusal> Barrier::resume(const wire::Hello& hello) {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& session) {
    return session->token == hello.session_token;
  });
  if (found == sessions_.end() || (*found)->roster.empty()) {
    return refusal(ErrorCode::no_such_session, "session_token",
                   "No session of this run has that token, or none any more.");
  }
  Session& session = **found;  // has robots, so that it survives being lost
  std::vector<std::size_t> robots;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (!session.roster.gone[i]) robots.push_back(session.roster.robots[i]);
  }
  if (auto refused = check_deadline(hello, robots)) return std::move(*refused);
  if (session.state != SessionState::lost) {
    outbox_.displaced(label(hello), "The session was taken up over another connection.");
    deliver(session, outbox_);
    lose(session, "it was taken up over another connection");
  }
  for (const std::size_t robot : robots) take_seat(robot, session);
  return &session;
}

/// Asks the connection itself; a session without is lost from then on.
bool Barrier::is_reachable(Session& session) {
  if (session.state == SessionState::lost) return false;
  outbox_.heartbeat(++heartbeats_);
  if (deliver(session, outbox_) != Delivery::unreachable) return true;
  lose(session, "its connection is gone");
  return false;
}

void Barrier::refuse(const std::string& peer, const wire::Hello& hello, wire::Refusal refused) {
  refused.fault.severity = wire::Severity::fatal;
  refused.fault.tick = observations_ ? observations_->tick : 0;
  refused.client_version = hello.version;
  outbox_.refusal(refused);
  send(peer, outbox_);
  note(fmt::format("{} was refused with {}: {}", label(hello), to_string(refused.fault.code),
                   refused.fault.message));
}

}  // namespace ziggurat::network
