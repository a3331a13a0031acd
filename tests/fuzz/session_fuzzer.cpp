// Any sequence of messages, losses, pauses, resets and time: what the barrier says of itself stays
// consistent, no session gets what is not for it, nothing grows without bound, and once every
// deadline is over the tick is, too. Each byte of the input is a step or says more of one.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "network/barrier.h"
#include "network/small_run.h"
#include "wire/messages.h"
#include "ziggurat/v1/protocol.pb.h"

namespace {

using namespace ziggurat;
using namespace ziggurat::network;
using std::chrono::milliseconds;

constexpr std::size_t robots = 4;
constexpr std::size_t seats = 5;  // peers at a time
constexpr std::size_t most_sessions = 3;

/// Ends the program, with the line that asked, unless the condition holds.
void require(bool condition, int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: this does not hold\n", __FILE__, line);
  std::abort();
}

struct Input {
  const std::uint8_t* data;
  std::size_t size;
  bool empty() const { return size == 0; }
  std::uint8_t byte() {
    if (size == 0) return 0;
    --size;
    return *data++;
  }
  std::size_t below(std::size_t limit) { return byte() % limit; }
};

/// What a connection has been told.
struct Told {
  bool welcomed = false;  ///< and nothing since that ends a session
  bool draining = false;  ///< was told the end
  bool has_tick = false;
  std::uint64_t tick = 0;
  std::string token;
  std::uint64_t robots = 0;
  Delivery delivery = Delivery::sent;  ///< what becomes of messages to it
  bool may_be_lost = false;            ///< a message did not reach it
};

Config make_config(Input& input) {
  Config config;
  config.max_sessions = most_sessions;
  config.max_faults = 3;
  config.rate = {20, 12};
  const std::uint8_t bits = input.byte();
  config.lease = milliseconds{bits % 2 == 0 ? 0 : 700};
  config.deadlines.resize(bits / 2 % 3);
  for (Config::Deadline& deadline : config.deadlines) {
    deadline.policy.action = static_cast<scene::DeadlineAction>(1 + input.below(5));
    if (deadline.policy.action != scene::DeadlineAction::wait) {
      deadline.policy = {deadline.policy.action, 100, static_cast<std::uint32_t>(input.below(3))};
    }
    deadline.is_fixed = bits >= 128;
  }
  return config;
}

class Play {
 public:
  Play(const SmallRun& small, Input input)
      : small_(small),
        input_(input),
        commands_(small.commands()),
        barrier_(
            make_config(input_), small.run(),
            [this](const std::string& peer, const wire::Outbox& message) {
              return hear(peer, message);
            },
            now_) {
    for (std::size_t i = 0; i < seats; ++i) connect(i);
  }

  void run() {
    while (!input_.empty()) {
      step();
      check();
    }
  }

 private:
  enum class Phase { gathering, collecting, between, over };

  void connect(std::size_t seat) {
    ids_[seat] = {static_cast<char>('a' + seat), static_cast<char>(++connections_ % 256),
                  static_cast<char>(connections_ / 256)};
    told_[ids_[seat]];
  }
  const std::string& peer() { return ids_[input_.below(seats)]; }

  Delivery hear(const std::string& peer, const wire::Outbox& outbox);
  void hear_tick(Told& told, const v1::Observation& observation) const;
  void say(const std::string& peer, const v1::ClientMessage& message);
  void say_hello();
  void say_command(const std::string& peer);
  void say_leave();
  void say_request();
  void say_anything();
  void answer_all();
  void pass();
  void move_on();
  void change_connection();
  void supervise();
  void step();
  void check();
  void check_robots(const wire::Status& status) const;
  void check_deadlines(const wire::Status& status);

  const SmallRun& small_;
  Input input_;
  std::array<std::string, seats> ids_;
  std::map<std::string, Told> told_;
  unsigned connections_ = 0;
  Clock::time_point now_{};
  world::Commands commands_;
  Phase phase_ = Phase::gathering;
  std::uint64_t tick_ = 0;  // published
  bool is_paused_ = false, is_stopped_ = false;
  bool has_looked_ = false;  // at deadlines, and nothing has happened since
  v1::ServerMessage heard_;
  std::vector<std::uint8_t> bytes_;
  Barrier barrier_;
};

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
      told.welcomed = true;
      told.draining = told.has_tick = told.may_be_lost = false;
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
      told.welcomed = false;
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
    case v1::ServerMessage::kHeartbeat:
      break;
    default:
      std::abort();
  }
  return Delivery::sent;
}

void Play::say(const std::string& peer, const v1::ClientMessage& message) {
  const bool takes = phase_ == Phase::collecting;
  barrier_.receive(peer, message.SerializeAsString(), takes ? &commands_ : nullptr);
}

void Play::say_hello() {
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

void Play::say_command(const std::string& from) {
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

void Play::say_leave() {
  const std::string& from = peer();
  const std::uint8_t bits = input_.byte();
  v1::ClientMessage message;
  v1::Leave& leave = *message.mutable_leave();
  leave.set_reason(bits % 2 == 0 ? v1::Leave::DONE : v1::Leave::FAILED);
  for (unsigned i = 0; i < robots; ++i) {
    if (bits >> (i + 1) & 1) leave.add_robots(i);
  }
  say(from, message);
  // It was thrown out for its many messages, or has left.
  if (leave.robots().empty()) told_.at(from).welcomed = false;
}

void Play::say_request() {
  const std::string& from = peer();
  v1::ClientMessage message;
  v1::Request& request = *message.mutable_request();
  request.set_id(input_.byte());
  if (request.id() % 3 != 0) request.mutable_status();
  say(from, message);
}

void Play::say_anything() {
  const std::string& from = peer();
  std::string bytes(input_.below(16), '\0');
  for (char& byte : bytes) byte = static_cast<char>(input_.byte());
  if (bytes.empty()) return barrier_.receive_malformed(from);
  barrier_.receive(from, bytes, phase_ == Phase::collecting ? &commands_ : nullptr);
  if (!barrier_.can_hear({from, {}})) told_.at(from).welcomed = false;
}

/// Everybody answers what it has been told last.
void Play::answer_all() {
  v1::ClientMessage message;
  for (const auto& [id, told] : told_) {
    if (!told.welcomed || !told.has_tick || phase_ != Phase::collecting) continue;
    if (barrier_.complete()) return;
    message.mutable_command()->set_tick(told.tick);
    say(id, message);
  }
}

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const SmallRun small(robots);
  Play(small, {data, size}).run();
  return 0;
}
