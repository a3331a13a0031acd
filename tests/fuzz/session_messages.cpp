// SPDX-License-Identifier: MIT
// Messages to peers, which are checked, and messages from peers.

#include <string>

#include "require.h"
#include "session_play.h"
#include "wire/messages.h"

namespace ziggurat::fuzz {

void Play::hear_tick(Told& told, const v1::Observation& observation) const {
  require(told.welcomed && !told.draining);
  require(phase_ != Phase::over && observation.tick() == tick_);
  require(observation.joint_readings_size() == static_cast<int>(told.robots));
  told.tick = tick_;
  told.has_tick = true;
}

Delivery Play::hear(const std::string& peer, const wire::Outbox& outbox) {
  Told& told = told_.at(peer);
  if (told.delivery != Delivery::sent) {
    told.may_be_lost = true;
    return told.delivery;
  }
  bytes_.resize(outbox.size());
  outbox.write(bytes_.data());
  if (bytes_.empty() || bytes_[0] == '{') return Delivery::sent;  // answers JSON
  require(heard_.ParseFromArray(bytes_.data(), static_cast<int>(bytes_.size())));
  switch (heard_.message_case()) {
    case v1::ServerMessage::kWelcome:
      require(phase_ != Phase::loading);
      told.welcomed = true;
      told.waiting = told.draining = told.has_tick = told.may_be_lost = false;
      told.token = heard_.welcome().session_token();
      told.robots = static_cast<std::uint64_t>(heard_.welcome().robots_size());
      break;
    case v1::ServerMessage::kObservation:
      hear_tick(told, heard_.observation());
      break;
    case v1::ServerMessage::kDisplaced:
      require(told.welcomed);
      told.welcomed = false;
      break;
    case v1::ServerMessage::kRefusal:
      require(!told.welcomed || told.may_be_lost || told.draining);  // of which none may be left
      told.welcomed = told.waiting = false;
      break;
    case v1::ServerMessage::kError:
      if (heard_.error().severity() == v1::Error::FATAL) told.welcomed = false;
      break;
    case v1::ServerMessage::kEnd:
      require(told.welcomed && phase_ == Phase::over);
      told.draining = true;
      break;
    case v1::ServerMessage::kPaused:
      require(told.welcomed && told.has_tick && is_paused_);
      break;
    case v1::ServerMessage::kReset:
    case v1::ServerMessage::kResponse:
      require(told.welcomed);
      break;
    case v1::ServerMessage::kLoading:
      require(!told.welcomed && heard_.loading().progress() <= 1);
      told.waiting = true;
      break;
    case v1::ServerMessage::kHeartbeat:
      break;
    default:
      std::abort();
  }
  return Delivery::sent;
}

void Play::say(const std::string& peer, const v1::ClientMessage& message) {
  receive(peer, message.SerializeAsString());
}

void Play::receive(const std::string& peer, std::string_view bytes, bool is_single_frame) {
  const bool is_collecting = phase_ == Phase::collecting;
  network::receive(barrier_, {peer, bytes, is_single_frame, Access{}},
                   is_collecting ? &commands_ : nullptr);
}

void Play::send_hello() {
  static const std::array<const char*, 6> wanted{"*",         "robot0", "robot1",
                                                 "robot[23]", "",       "robot9"};
  const std::string& from = peer();
  const std::uint8_t bits = input_.byte();
  v1::ClientMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.mutable_version()->set_major(bits == 255 ? 2 : 1);
  const std::size_t names = input_.below(9);
  hello.set_role(names == 8 ? v1::ROLE_SUPERVISOR : v1::ROLE_CONTROLLER);
  if (names < wanted.size()) hello.add_robots(wanted[names]);
  if (names == 6) hello.set_controller("external");
  if (names == 7) hello.set_lua_only(true);
  hello.set_takeover(bits % 2 == 1);
  if (bits / 2 % 4 == 3) hello.set_session_token(told_.at(peer()).token);
  if (bits / 8 % 2 == 1) {
    auto& wish = *hello.mutable_deadline_policy();
    wish.set_action(static_cast<v1::DeadlinePolicy::Action>(input_.below(7)));
    wish.set_wall_deadline_ms(static_cast<std::uint32_t>(input_.below(5)) * 100);
    wish.set_miss_budget(static_cast<std::uint32_t>(input_.below(3)));
  }
  say(from, message);
}

void Play::send_command(const std::string& from) {
  const Told& told = told_.at(from);
  const std::uint8_t bits = input_.byte();
  v1::ClientMessage message;
  v1::Command& command = *message.mutable_command();
  command.set_tick(told.tick + bits % 4 / 2 - bits / 4 % 2);
  std::uint64_t values = told.robots;
  if (bits / 8 % 4 == 3) {
    command.add_robots(bits / 32 % 4);
    values = 1;
  }
  if (bits % 2 == 1) {
    for (std::uint64_t i = 0; i < values; ++i) command.add_joint_targets(1);
  }
  if (bits >= 192) command.add_log()->set_robot(bits / 32 % 4);
  say(from, message);
}

void Play::send_leave() {
  const std::string& from = peer();
  const std::uint8_t bits = input_.byte();
  v1::ClientMessage message;
  v1::Leave& leave = *message.mutable_leave();
  leave.set_reason(bits % 2 == 0 ? v1::Leave::DONE : v1::Leave::FAILED);
  for (unsigned i = 0; i < robots; ++i) {
    if (bits >> (i + 1) & 1) leave.add_robots(i);
  }
  say(from, message);
  // It was closed for its many messages, or has left.
  if (leave.robots().empty()) told_.at(from).welcomed = false;
}

void Play::send_request() {
  const std::string& from = peer();
  v1::ClientMessage message;
  v1::Request& request = *message.mutable_request();
  request.set_id(input_.byte());
  if (request.id() % 3 != 0) request.mutable_status();
  say(from, message);
}

void Play::send_anything() {
  const std::string& from = peer();
  std::string bytes(input_.below(16), '\0');
  for (char& byte : bytes) byte = static_cast<char>(input_.byte());
  receive(from, bytes, !bytes.empty());
  if (barrier_.connections.session_of(from) == network::SessionId::none)
    told_.at(from).welcomed = told_.at(from).waiting = false;
}

/// Every peer answers the last observation that it was sent.
void Play::answer_all() {
  v1::ClientMessage message;
  for (const auto& [id, told] : told_) {
    if (!told.welcomed || !told.has_tick || phase_ != Phase::collecting) continue;
    if (barrier_.gate.is_complete()) return;
    message.mutable_command()->set_tick(told.tick);
    say(id, message);
  }
}

}  // namespace ziggurat::fuzz
