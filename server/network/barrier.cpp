#include "network/barrier.h"

#include <fmt/format.h>

#include <algorithm>

#include "wire/fault.h"
#include "wire/zero.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using wire::Severity;

namespace {

constexpr std::size_t max_notices = 100;
constexpr std::size_t max_notice = 1000;    // bytes
constexpr std::size_t max_failure = 16384;  // bytes of a failure's message
constexpr std::size_t robots_named = 3;     // in messages that could name hundreds

}  // namespace

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& character : result) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7F) character = '?';
  }
  return result;
}

Barrier::Barrier(const Config& config, const wire::Run& run, Send send)
    : config_(config),
      run_(run),
      send_([this, send = std::move(send)](const std::string& peer, wire::Outbox& message) {
        message.encode(encoding_of(peer));
        return send(peer, message);
      }),
      seats_(run.layout.robots.size()),
      free_(seats_.size()) {
  run_.max_message_bytes = config.max_message_bytes;
}

void Barrier::receive(const std::string& peer, std::string_view bytes, world::Commands* commands) {
  const auto found = by_peer_.find(peer);
  Session* session = found == by_peer_.end() ? nullptr : found->second;
  if (session != nullptr) session->last_message = std::chrono::steady_clock::now();
  if (session == nullptr) stranger_ = wire::encoding_of(bytes);
  if (bytes.size() > config_.max_message_bytes) {
    return fail(peer, session,
                make_fault(ErrorCode::too_large, {},
                           fmt::format("The message has {} bytes; {} are allowed.", bytes.size(),
                                       config_.max_message_bytes)));
  }
  if (session != nullptr && wire::encoding_of(bytes) != session->encoding) {
    const bool is_json = session->encoding == wire::Encoding::json;
    return say_malformed(peer, session,
                         is_json ? "this session talks JSON" : "this session does not talk JSON");
  }
  const auto kind = inbox_.parse(bytes);
  if (kind == wire::Inbox::Kind::malformed) return say_malformed(peer, session, inbox_.complaint());
  if (session == nullptr) {
    if (kind == wire::Inbox::Kind::hello) return say_hello(peer);
    return fail(
        peer, nullptr,
        make_fault(ErrorCode::out_of_state, {}, "The first message of a session is Hello."));
  }
  switch (kind) {
    case wire::Inbox::Kind::command:
      return say_command(*session, commands);
    case wire::Inbox::Kind::leave:
      return say_leave(*session);
    case wire::Inbox::Kind::heartbeat:
      return say_heartbeat(peer);
    case wire::Inbox::Kind::request:
      return fail(peer, session,
                  make_fault(ErrorCode::forbidden, {}, "A controller can't make requests."),
                  inbox_.request_id());
    default:
      fail(peer, session,
           make_fault(ErrorCode::out_of_state, {}, "This session has had its Hello already."));
  }
}

void Barrier::receive_malformed(const std::string& peer) {
  const auto found = by_peer_.find(peer);
  stranger_ = wire::Encoding::binary;
  say_malformed(peer, found == by_peer_.end() ? nullptr : found->second, {});
}

void Barrier::say_malformed(const std::string& peer, Session* session, std::string_view why) {
  fail(peer, session,
       make_fault(ErrorCode::malformed, {},
                  fmt::format("Not a ClientMessage of ziggurat.v1: {}.",
                              why.empty() ? "one ZeroMQ frame holds one message" : why)));
}

/// A session's form is that of its Hello; whoever has none is answered as spoken to.
wire::Encoding Barrier::encoding_of(const std::string& peer) const {
  const auto found = by_peer_.find(peer);
  return found == by_peer_.end() ? stranger_ : found->second->encoding;
}

/// Answers a bad message, and throws out whoever sends nothing else.
/// @param request  the number of the request that the message was, if it was one
void Barrier::fail(const std::string& peer, Session* session, wire::Fault fault,
                   std::optional<std::uint64_t> request) {
  fault.tick = observations_ ? observations_->tick : 0;
  const bool is_last = session != nullptr && ++session->faults > config_.max_faults;
  if (is_last) {
    fault.code = ErrorCode::too_many;
    fault.message =
        fmt::format("{} bad messages in a row; the last one: {}", session->faults, fault.message);
  }
  if (session == nullptr || is_last) fault.severity = Severity::fatal;
  if (request && !is_last) {
    outbox_.response(*request, fault);
  } else {
    outbox_.error(fault);
  }
  const Delivery delivery = send_(peer, outbox_);
  if (session == nullptr) {
    note(fmt::format("A peer without session was answered {}: {}", to_string(fault.code),
                     fault.message));
    return;
  }
  note(
      fmt::format("{} was answered {}: {}", session->client, to_string(fault.code), fault.message));
  if (is_last) return lose(*session, "it was thrown out for its bad messages");
  if (delivery == Delivery::unreachable) lose(*session, "its connection is gone");
}

void Barrier::say_heartbeat(const std::string& peer) {
  outbox_.heartbeat(inbox_.heartbeat());
  send_(peer, outbox_);  // if it is gone, the next observation or probe finds out
}

void Barrier::say_leave(Session& session) {
  if (auto fault = inbox_.check(session.roster, run_.layout)) {
    return fail(session.peer, &session, std::move(*fault));
  }
  session.faults = 0;
  inbox_.append_log(session.roster, report_.log);
  const wire::Leave leave = inbox_.leave();
  const bool is_whole = leave.robots.empty();
  std::vector<std::size_t> positions(leave.robots.begin(), leave.robots.end());
  for (std::size_t i = 0; is_whole && i < session.roster.robots.size(); ++i) positions.push_back(i);
  for (const std::size_t position : positions) {
    const std::size_t robot = session.roster.robots[position];
    const bool is_failure = leave.reason == wire::LeaveReason::failed;
    if (is_failure && !session.roster.gone[position] && session.state != SessionState::draining) {
      report_.failures.push_back({robot, leave.message.substr(0, max_failure), session.tick});
    }
    mark_gone(&session, robot);
  }
  if (is_whole) erase(session);
}

/// Takes a robot out of the barrier for good.
void Barrier::mark_gone(Session* session, std::size_t robot) {
  Seat& seat = seats_[robot];
  if (session != nullptr) {
    const auto& robots = session->roster.robots;
    const auto found = std::lower_bound(robots.begin(), robots.end(), robot);
    session->roster.leave(static_cast<std::size_t>(found - robots.begin()));
  }
  if (seat.gone) return;
  if (seat.holder == nullptr) --free_;
  seat.gone = true;
  seat.holder = nullptr;
}

/// The session owes nothing any more.
void Barrier::settle(Session& session) {
  if (!session.owes) return;
  session.owes = false;
  --owing_;
}

/// Its robots wait for somebody to take them; it may resume.
void Barrier::lose(Session& session, std::string_view why) {
  if (session.state == SessionState::lost) return;
  const std::string robots = robots_of(session);
  if (session.state != SessionState::draining) {
    note(fmt::format("{} ({}) is lost: {}", session.client, robots, why));
  }
  settle(session);
  by_peer_.erase(session.peer);
  for (const std::size_t robot : session.roster.robots) {
    if (seats_[robot].holder != &session) continue;
    seats_[robot].holder = nullptr;
    seats_[robot].free_since = std::chrono::steady_clock::now();
    ++free_;
  }
  const bool can_resume = session.state != SessionState::draining && !session.roster.empty();
  session.state = SessionState::lost;
  if (!can_resume) erase(session);
}

void Barrier::erase(Session& session) {
  settle(session);
  if (session.state != SessionState::lost) by_peer_.erase(session.peer);
  std::erase_if(sessions_, [&](const auto& entry) { return entry.get() == &session; });
}

void Barrier::remove_robots(std::span<const std::size_t> robots) {
  for (const std::size_t robot : robots) {
    Session* session = seats_[robot].holder;
    mark_gone(session, robot);
    if (session != nullptr && session->roster.empty()) settle(*session);
  }
}

void Barrier::finish(const wire::End& end) {
  finished_ = true;
  outbox_.end(end);
  std::vector<Session*> unreachable;
  for (const auto& session : sessions_) {
    settle(*session);
    if (session->state == SessionState::lost || send_(session->peer, outbox_) != Delivery::sent) {
      unreachable.push_back(session.get());
    } else {
      session->state = SessionState::draining;
    }
  }
  for (Session* session : unreachable) erase(*session);
}

bool Barrier::drained() const { return sessions_.empty(); }

void Barrier::probe() {
  outbox_.heartbeat(++heartbeats_);
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    if (session->state == SessionState::lost) continue;
    if (send_(session->peer, outbox_) == Delivery::unreachable) gone.push_back(session.get());
  }
  for (Session* session : gone) lose(*session, "its connection is gone");
}

void Barrier::zero_gone(world::Commands& commands) const {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (!seats_[i].gone) continue;
    wire::zero(run_.layout, i, commands);
  }
}

std::vector<RobotStatus> Barrier::status() const {
  std::vector<RobotStatus> result(seats_.size());
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    const Seat& seat = seats_[i];
    RobotStatus& status = result[i];
    if (seat.gone) {
      status.membership = RobotStatus::Membership::gone;
    } else if (seat.holder != nullptr) {
      status.membership = RobotStatus::Membership::held;
      status.holder = seat.holder->client;
      status.awaited = seat.holder->owes;
      status.awaited_since = seat.holder->owes_since;
      status.last_message = seat.holder->last_message;
    } else {
      status.awaited = true;
      status.awaited_since = seat.free_since;
    }
  }
  return result;
}

Report Barrier::take_report() {
  const auto by_robot = [](const auto& a, const auto& b) { return a.robot < b.robot; };
  std::stable_sort(report_.log.begin(), report_.log.end(), by_robot);
  std::stable_sort(report_.failures.begin(), report_.failures.end(), by_robot);
  return std::exchange(report_, {});
}

void Barrier::note(std::string text) {
  text = printable(std::string_view(text).substr(0, max_notice));
  if (report_.notices.size() == max_notices) report_.notices.erase(report_.notices.begin());
  report_.notices.push_back(std::move(text));
}

std::string Barrier::robots_of(const Session& session) const {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < session.roster.robots.size(); ++i) {
    if (session.roster.gone[i] || ++count > robots_named) continue;
    text += (text.empty() ? "" : ", ") + run_.layout.robots[session.roster.robots[i]].id;
  }
  if (count > robots_named) text += fmt::format(" and {} more", count - robots_named);
  return text.empty() ? "no robots" : text;
}

}  // namespace ziggurat::network
