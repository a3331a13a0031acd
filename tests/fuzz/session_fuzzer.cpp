// Any sequence of messages, losses, pauses, resets and time: what the barrier says of itself stays
// consistent, no session gets what is not for it, nothing grows without bound, and once every
// deadline is over the tick is, too. Each byte of the input is a step or says more of one.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "require.h"
#include "session_play.h"

namespace ziggurat::fuzz {

void Play::pass() {
  static constexpr std::array<int, 8> times{1, 20, 99, 101, 500, 1000, 5000, 61'000};
  const int time = times[input_.below(times.size())];
  barrier_.advance(now_ += milliseconds{time});
  has_looked_ = true;
  require(barrier_.due() > now_);  // or the server would never sleep
}

/// What the server's owner does when nothing is left to wait for.
void Play::move_on() {
  barrier_.advance(now_);
  if (phase_ == Phase::collecting && barrier_.complete()) {
    barrier_.zero_missing(commands_);
    phase_ = Phase::between;
    if (input_.below(2) == 1) return;  // paced: it lingers
  }
  if (phase_ == Phase::between) {
    ++tick_;
  } else if (phase_ != Phase::gathering || !barrier_.gathered()) {
    return;
  }
  phase_ = Phase::collecting;
  barrier_.publish(small_.observations(tick_), {});
}

void Play::change_connection() {
  const std::size_t seat = input_.below(seats);
  Told& told = told_.at(ids_[seat]);
  switch (input_.below(4)) {
    case 0:
      told.delivery = Delivery::unreachable;  // for good: whoever comes back has another id
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
  switch (input_.below(7)) {
    case 0:
      is_paused_ = true;
      return barrier_.pause();
    case 1:
      barrier_.advance(now_);
      is_paused_ = false;
      return barrier_.resume();
    case 2:
      if (phase_ != Phase::collecting) return;
      barrier_.reset(7);
      phase_ = Phase::gathering;
      tick_ = 0;
      return;
    case 3: {
      const std::vector<std::size_t> gone{input_.below(robots)};
      return barrier_.remove_robots(gone);
    }
    case 4:
      for (const Call& call : barrier_.take_calls()) {
        barrier_.answer(call, [&](wire::Outbox& out) { out.response(call.request.id, tick_); });
      }
      return;
    case 5: {
      const Report report = barrier_.take_report();
      is_stopped_ |= !report.stopped.empty();
      require(report.notices.size() <= 100);
      for (const wire::LogLine& line : report.log) require(line.robot < robots);
      return;
    }
    default:
      if (phase_ == Phase::over || input_.below(8) != 0) return;
      phase_ = Phase::over;
      return barrier_.finish({wire::EndReason::finished, {}, tick_});
  }
}

void Play::step() {
  has_looked_ = false;
  switch (input_.below(16)) {
    case 0:
    case 1:
    case 2:
      return say_hello();
    case 3:
    case 4:
      return say_command(peer());
    case 5:
      return say_leave();
    case 6:
      return say_request();
    case 7:
      return say_anything();
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

/// Unless somebody is waited for that is not due yet, the tick is over.
void Play::check_deadlines(const wire::Status& status) {
  if (!has_looked_ || phase_ != Phase::collecting || is_paused_ || barrier_.complete()) return;
  for (const wire::SessionStatus& session : status.sessions) {
    // Its robots have left; what it owes is due as it was for them.
    if (session.state == wire::SessionStatus::State::owing && session.robots.empty()) return;
  }
  const auto is_not_due = [&](const RobotStatus& robot) {
    const milliseconds deadline{robot.deadline.wall_deadline_ms};
    return robot.awaited && (robot.deadline.action == scene::DeadlineAction::wait ||
                             now_ < robot.awaited_since + deadline);
  };
  if (std::ranges::any_of(barrier_.status(), is_not_due)) return;
  is_stopped_ |= !barrier_.take_report().stopped.empty();
  require(is_stopped_);
}

void Play::check() {
  wire::Status status;
  barrier_.fill(status);
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
  const Barrier::Known known = barrier_.known();
  require(known.sessions == status.sessions.size());
  require(connected <= most_sessions && known.sessions - connected <= robots);
  require(known.peers <= 2 * most_sessions + 1);
  require(barrier_.drained() == status.sessions.empty());

  bool is_free = false, is_awaited = false;
  for (const RobotStatus& robot : barrier_.status()) {
    using Membership = RobotStatus::Membership;
    is_free |= robot.membership == Membership::free;
    if (robot.membership == Membership::gone) continue;
    is_awaited |= robot.awaited;
    require(robot.membership != Membership::held || !robot.holder.empty());
  }
  require(barrier_.gathered() == !is_free);
  if (barrier_.complete()) require(!is_paused_ && !owes && !is_awaited);
  if (barrier_.standing()) require(is_paused_);
  for (const double target : commands_.joint_targets) require(target == 0 || target == 1);
}

}  // namespace ziggurat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ziggurat;
  static const network::SmallRun small(fuzz::robots);
  fuzz::Play(small, {data, size}).run();
  return 0;
}
