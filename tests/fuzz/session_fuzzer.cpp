// SPDX-License-Identifier: MIT
// Any sequence of messages, losses, pauses, resets and time, from before the world is loaded to the
// end. The barrier's status stays consistent, no session gets another's messages, and nothing grows
// without bound. A tick is complete once every deadline has passed. Each byte of the input is a
// step or a detail of one.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "require.h"
#include "session_play.h"

namespace ziggurat::fuzz {

/// The world is loaded.
void Play::open() {
  phase_ = Phase::gathering;
  network::open(barrier_, small_.run(), config_);
  admit_waiting(barrier_);
}

void Play::pass() {
  static constexpr std::array<int, 8> times{1, 20, 99, 101, 500, 1000, 5000, 61'000};
  const int time = times[input_.below(times.size())];
  advance(barrier_, now_ += milliseconds{time});
  has_looked_ = true;
  require(next_event(barrier_) > now_);  // or the server would never sleep
}

/// Step of the program when nothing is left to wait for.
void Play::move_on() {
  advance(barrier_, now_);
  if (phase_ == Phase::loading) return open();
  if (phase_ == Phase::collecting && barrier_.gate.is_complete()) {
    zero_missing(barrier_, commands_);
    phase_ = Phase::between;
    if (input_.below(2) == 1) return;  // paced: it lingers
  }
  if (phase_ == Phase::between) {
    ++tick_;
  } else if (phase_ != Phase::gathering || !barrier_.ownership.all_taken()) {
    return;
  }
  phase_ = Phase::collecting;
  observations_ = small_.observations(tick_);
  publish(barrier_, observations_, payloads_);
}

void Play::change_connection() {
  const std::size_t seat = input_.below(seats);
  Told& told = told_.at(ids_[seat]);
  switch (input_.below(4)) {
    case 0:
      told.delivery = Delivery::unreachable;  // for good: a client that comes back has another id
      break;
    case 1:
      if (told.delivery == Delivery::unreachable) connect(seat);
      break;
    case 2:
      if (told.delivery == Delivery::sent) told.delivery = Delivery::congested;
      break;
    default:
      if (told.delivery == Delivery::congested) told.delivery = Delivery::sent;
  }
}

void Play::supervise() {
  if (phase_ == Phase::loading) return;
  switch (input_.below(7)) {
    case 0:
      is_paused_ = true;
      return pause(barrier_);
    case 1:
      advance(barrier_, now_);
      is_paused_ = false;
      return resume(barrier_);
    case 2:
      if (phase_ != Phase::collecting) return;
      restart(barrier_, {7});
      phase_ = Phase::gathering;
      tick_ = 0;
      return;
    case 3: {
      const std::vector<std::size_t> gone{input_.below(robots)};
      return remove_robots(barrier_, gone, {});
    }
    case 4:
      for (const Call& call : barrier_.calls.take()) {
        answer(barrier_, call, [&](wire::Outbox& out) { out.response(call.request.id, tick_); });
      }
      return;
    case 5: {
      const Report report = barrier_.journal.take();
      is_stopped_ |= !report.stopped.empty();
      require(report.notices.size() <= 100);
      for (const wire::LogLine& line : report.log) require(line.robot < robots);
      return;
    }
    default:
      if (phase_ == Phase::over || input_.below(8) != 0) return;
      phase_ = Phase::over;
      return finish(barrier_, {wire::EndReason::finished, {}, tick_});
  }
}

void Play::step() {
  has_looked_ = false;
  switch (input_.below(16)) {
    case 0:
    case 1:
    case 2:
      return send_hello();
    case 3:
    case 4:
      return send_command(peer());
    case 5:
      return send_leave();
    case 6:
      return send_request();
    case 7:
      return send_anything();
    case 8:
    case 9:
      return answer_all();
    case 10:
      return pass();
    case 11:
    case 12:
      return move_on();
    case 13:
      return change_connection();
    default:
      return supervise();
  }
}

/// Every robot is somewhere, and in one place.
void Play::check_robots(const wire::Status& status) const {
  std::array<int, robots> places{};
  const auto count = [&](const std::vector<std::string>& ids) {
    for (const std::string& id : ids) ++places.at(static_cast<std::size_t>(id.back() - '0'));
  };
  count(status.free_robots);
  count(status.gone_robots);
  for (const wire::SessionStatus& session : status.sessions) count(session.robots);
  require(std::ranges::all_of(places, [](int place) { return place == 1; }));
}

/// Unless a robot is waited for whose deadline has not passed, the tick is complete.
void Play::check_deadlines(const wire::Status& status) {
  if (!has_looked_ || phase_ != Phase::collecting || is_paused_ || barrier_.gate.is_complete())
    return;
  for (const wire::SessionStatus& session : status.sessions) {
    // Its robots have left; what it owes keeps the deadline that it had for them.
    if (session.state == wire::SessionStatus::State::owing && session.robots.empty()) return;
  }
  const auto may_still_answer = [&](const RobotStatus& robot) {
    const milliseconds deadline{robot.deadline.wall_deadline_ms};
    return robot.awaited && (robot.deadline.action == scene::DeadlineAction::wait ||
                             now_ < robot.awaited_since + deadline);
  };
  if (std::ranges::any_of(robot_status(barrier_), may_still_answer)) return;
  is_stopped_ |= !barrier_.journal.take().stopped.empty();
  require(is_stopped_);
}

void Play::check() {
  if (phase_ == Phase::loading) {
    require(barrier_.sessions.size() <= most_sessions && !barrier_.gate.tick());
    return;
  }
  wire::Status status;
  fill(barrier_, now_, status);
  check_robots(status);
  check_deadlines(status);

  using State = wire::SessionStatus::State;
  std::size_t connected = 0;
  bool owes = false;
  for (const wire::SessionStatus& session : status.sessions) {
    if (session.state != State::lost) ++connected;
    if (session.state == State::lost) require(!session.robots.empty());
    owes |= session.state == State::owing;
  }
  const std::size_t known = barrier_.sessions.size();
  require(known == status.sessions.size());
  require(connected <= most_sessions && known - connected <= robots);
  require(barrier_.connections.size() <= 2 * most_sessions + 1);

  bool is_free = false, is_awaited = false;
  for (const RobotStatus& robot : robot_status(barrier_)) {
    using Membership = RobotStatus::Membership;
    is_free |= robot.membership == Membership::free;
    if (robot.membership == Membership::gone) continue;
    is_awaited |= robot.awaited;
    require(robot.membership != Membership::held || !robot.holder.empty());
  }
  require(barrier_.ownership.all_taken() == !is_free);
  if (barrier_.gate.is_complete()) require(!is_paused_ && !owes && !is_awaited);
  if (barrier_.gate.is_halted()) require(is_paused_);
  for (const double target : commands_.joint_targets) require(target == 0 || target == 1);
}

}  // namespace ziggurat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ziggurat;
  static const network::SmallRun small(fuzz::robots);
  fuzz::Play(small, {data, size}).run();
  return 0;
}
