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

Barrier::Barrier(const Config& config, const wire::Run& run, Send send, Clock::time_point now)
    : config_(config),
      run_(run),
      send_(std::move(send)),
      now_(now),
      seats_(run.layout.robots.size()),
      free_(seats_.size()),
      next_heartbeat_(now + config.heartbeat),
      missed_ticks_(run.controllers.size()),
      last_missed_(run.controllers.size()),
      lost_(run.controllers.size()),
      latencies_(run.controllers.size()) {
  run_.max_message_bytes = config.max_message_bytes;
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    seats_[i].deadline = policy_of(i);
    seats_[i].free_since = now;
  }
}

void Barrier::advance(Clock::time_point now) {
  now_ = now;
  if (now_ >= next_departure_) send_due();
  if (now_ >= next_deadline_) check_deadlines();
  if (now_ >= next_heartbeat_) send_heartbeats();
}

void Barrier::receive(const std::string& peer, std::string_view bytes, world::Commands* commands,
                      const Roles& roles) {
  Peer& from = find_peer(peer);
  Session* session = from.session;
  if (session == nullptr) stranger_ = wire::encoding_of(bytes);
  if (!afford(peer, from)) return;
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
    if (kind == wire::Inbox::Kind::hello) return say_hello(peer, roles);
    return fail(
        peer, nullptr,
        make_fault(ErrorCode::out_of_state, {}, "The first message of a session is Hello."));
  }
  if (!is_held_back(*session, kind, bytes)) take(*session, kind, commands);
  if (is_paused_) stand();
}

/// The message in hand, which is one of the session's.
void Barrier::take(Session& session, wire::Inbox::Kind kind, world::Commands* commands) {
  switch (kind) {
    case wire::Inbox::Kind::command:
      if (say_command(session, commands)) peers_.at(session.peer).allowance.give_back();
      break;
    case wire::Inbox::Kind::leave:
      say_leave(session);
      break;
    case wire::Inbox::Kind::heartbeat:
      say_heartbeat(session.peer);
      break;
    case wire::Inbox::Kind::request:
      say_request(session);
      break;
    default:
      fail(session.peer, &session,
           make_fault(ErrorCode::out_of_state, {}, "This session has had its Hello already."));
  }
}

void Barrier::receive_malformed(const std::string& peer) {
  Peer& from = find_peer(peer);
  stranger_ = wire::Encoding::binary;
  if (afford(peer, from)) say_malformed(peer, from.session, {});
}

void Barrier::say_malformed(const std::string& peer, Session* session, std::string_view why) {
  fail(peer, session,
       make_fault(ErrorCode::malformed, {},
                  fmt::format("Not a ClientMessage of ziggurat.v1: {}.",
                              why.empty() ? "one ZeroMQ frame holds one message" : why)));
}

/// A session's form is that of its Hello; whoever has none is answered as spoken to.
wire::Encoding Barrier::encoding_of(const std::string& peer) const {
  const auto found = peers_.find(peer);
  const Session* session = found == peers_.end() ? nullptr : found->second.session;
  return session == nullptr ? stranger_ : session->encoding;
}

/// The connection that a message came from. Those without session are forgotten when there are
/// too many, first those that have been quiet.
Barrier::Peer& Barrier::find_peer(const std::string& id) {
  if (const auto found = peers_.find(id); found != peers_.end()) {
    Peer& peer = found->second;
    if (peer.session != nullptr) {
      peer.session->last_message = now_;
      peer.session->heartbeats = 0;
    }
    return peer;
  }
  if (peers_.size() >= 2 * config_.max_sessions) {
    std::erase_if(peers_, [&](const auto& entry) {
      return !entry.second.session && entry.second.allowance.is_full(config_.rate, now_);
    });
  }
  if (peers_.size() >= 2 * config_.max_sessions) {
    std::erase_if(peers_, [](const auto& entry) { return !entry.second.session; });
  }
  return peers_.try_emplace(id, Peer{nullptr, false, {config_.rate, now_}}).first->second;
}

/// Whether the connection may send one more message; if not, it is told once.
bool Barrier::afford(const std::string& id, Peer& peer) {
  if (peer.allowance.take(config_.rate, now_)) {
    peer.is_told = false;
    return true;
  }
  if (std::exchange(peer.is_told, true)) return false;
  auto fault = make_fault(ErrorCode::too_many, {},
                          fmt::format("More than {} messages a second, besides those that answer "
                                      "an Observation.",
                                      config_.rate.per_second));
  fault.severity = Severity::fatal;
  fault.tick = observations_ ? observations_->tick : 0;
  outbox_.error(fault);
  send(id, outbox_);
  if (peer.session != nullptr) {
    lose(*peer.session, "it was thrown out for its many messages");
  } else {
    note("A peer without session sends too many messages and is not answered any more.");
  }
  return false;
}

/// In the peer's form, and behind what is held back for it.
Delivery Barrier::send(const std::string& peer, wire::Outbox& message) {
  message.encode(encoding_of(peer));
  const auto found = peers_.find(peer);
  Session* session = found == peers_.end() ? nullptr : found->second.session;
  if (session == nullptr || session->outgoing.empty()) return send_(peer, message);
  return hold_back(*session, message, Clock::duration::zero());
}

Delivery Barrier::deliver(Session& session, wire::Outbox& message) {
  session.last_sent = now_;
  return send(session.peer, message);
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
  const Delivery delivery = send(peer, outbox_);
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
  send(peer, outbox_);  // if it is gone, the next observation or probe finds out
}

void Barrier::say_leave(Session& session) {
  const bool is_forgotten =
      session.state == SessionState::draining && session.roster.robots.empty();
  if (is_forgotten) return erase(session);  // what its robots still log is nobody's
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
    if (session.roster.gone[position]) continue;
    const std::size_t robot = session.roster.robots[position];
    const bool is_failure = leave.reason == wire::LeaveReason::failed;
    if (is_failure && session.state != SessionState::draining) {
      report_.failures.push_back({robot, leave.message.substr(0, max_failure), session.tick});
    }
    mark_gone(robot);
  }
  if (is_whole) erase(session);
}

void Barrier::finish(const wire::End& end) {
  is_finished_ = true;
  outbox_.end(end);
  std::vector<Session*> done;
  for (const auto& session : sessions_) {
    if (session->state == SessionState::draining) continue;  // it is told already
    settle(*session);
    stop_delays(*session);
    const bool waits = session->role == wire::Role::controller;  // for its last words
    if (session->state == SessionState::lost || deliver(*session, outbox_) != Delivery::sent ||
        !waits) {
      done.push_back(session.get());
    } else {
      session->state = SessionState::draining;
    }
  }
  for (Session* session : done) erase(*session);
}

bool Barrier::drained() const { return sessions_.empty(); }

void Barrier::zero_missing(world::Commands& commands) {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (!seats_[i].gone && !seats_[i].zeroed) continue;
    wire::zero(run_.layout, i, commands);
    seats_[i].zeroed = false;
  }
}

std::vector<RobotStatus> Barrier::status() const {
  std::vector<RobotStatus> result(seats_.size());
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    const Seat& seat = seats_[i];
    RobotStatus& status = result[i];
    status.deadline = seat.deadline;
    status.was_held = seat.was_held;
    if (seat.gone) {
      status.membership = RobotStatus::Membership::gone;
    } else if (seat.holder != nullptr) {
      status.membership = RobotStatus::Membership::held;
      status.holder = seat.holder->client;
      status.awaited = seat.holder->owes;
      status.awaited_since = seat.holder->owes_since;
      status.last_message = seat.holder->last_message;
    } else {
      if (seat.claimant != nullptr) status.holder = seat.claimant->client;
      status.awaited = !seat.passed;
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
