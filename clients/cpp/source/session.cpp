#include "ziggurat/session.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "session_state.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {
namespace {

ProtocolError displaced(const v1::Displaced& by) {
  ProtocolError::Details details;
  details.code = "DISPLACED";
  details.holder = by.by();
  return ProtocolError("DISPLACED: " + by.message(), details);
}

/// The tick did not wait for our answer, or already had it: the next observation arrives anyway.
/// @param may_have_jumped  the world was reset, or the session resumed: an answer that was sent before may have
///                         a future tick
bool is_harmless(const v1::Error& error, bool may_have_jumped) {
  if (error.severity() == v1::Error::FATAL) return false;
  return error.severity() == v1::Error::WARNING || error.code() == v1::Error::STALE_TICK ||
         error.code() == v1::Error::DUPLICATE_TICK ||
         (error.code() == v1::Error::FUTURE_TICK && may_have_jumped);
}

}  // namespace

Session::Session(const Options& options) : state_(std::make_unique<State>(options)) {
  state_->open();
}

Session::~Session() {
  try {
    if (std::uncaught_exceptions() > state_->exceptions) {
      leave_failed("an exception ended the controller");
    } else {
      leave();
    }
  } catch (const std::exception&) {
    // The server is gone.
  }
}

bool Session::next() {
  State& state = *state_;
  if (state.ending || state.is_over) return false;
  if (state.owes) state.answer();
  for (;;) {
    try {
      return state.wait();
    } catch (const ConnectionError& loss) {
      if (!state.connection.is_lost()) throw;
      if (!state.resume(loss.what())) return false;
    }
  }
}

void Session::State::answer() {
  failures = fleet->take_failures();
  v1::Command& command = *outgoing.mutable_command();
  command.Clear();
  command.set_tick(tick);
  if (epoch) command.set_epoch(*epoch);
  fleet->write(command);
  owes = false;
  send_answer();
  fleet->sent();
}

void Session::State::send_answer() {
  for (const v1::Leave& leave : failures) {
    v1::ClientMessage message;
    *message.mutable_leave() = leave;
    connection.send(message);
  }
  connection.send(outgoing);
}

bool Session::State::wait() {
  // Heartbeats come in between: they do not extend the time-out.
  const auto end = Clock::now() + options.wait_timeout.value_or(std::chrono::milliseconds{0});
  auto rest = options.wait_timeout;
  for (;;) {
    const auto kind = connection.receive(rest, options.is_interrupted);
    if (rest) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
      rest = std::max(left, std::chrono::milliseconds{0});
    }
    if (!kind && is_interrupted()) return false;
    if (!kind) {
      throw ConnectionError("the server at " + options.endpoint + " sent no observation for " +
                            std::to_string(options.wait_timeout->count()) +
                            " ms after the answer to tick " + std::to_string(tick));
    }
    const v1::ServerMessage& message = connection.message();
    switch (*kind) {
      case Connection::Kind::kObservation:
        if (repeats_answer(connection.observation())) break;
        read(connection.observation());
        return true;
      case Connection::Kind::kEnd:
        read(message.end());
        return false;
      case Connection::Kind::kReset:
        read(message.reset());
        break;
      case Connection::Kind::kRestored:
        read(message.restored());
        break;
      case Connection::Kind::kError:
        take(message.error());
        break;
      case Connection::Kind::kRobotSpawned:
        read(message.robot_spawned());
        break;
      case Connection::Kind::kDisplaced:
        is_over = true;
        throw displaced(message.displaced());
      default:
        break;  // a heartbeat, or a message of a later version
    }
  }
}

void Session::State::take(const v1::Error& error) {
  if (is_harmless(error, was_reset || resumes > 0)) {
    if (error.code() == v1::Error::DEADLINE_MISSED) ++missed;
    fleet->remove(error.dropped().robots());
    // The first answer counts, unless it was for the world before the reset.
    if (error.code() != v1::Error::DUPLICATE_TICK || was_reset) fleet->repeat();
    return;
  }
  const bool is_fatal = error.severity() == v1::Error::FATAL;
  if (is_fatal && error.code() == v1::Error::OUT_OF_STATE) {
    connection.lose("the server does not know the connection");
  }
  is_over = is_fatal;
  throw to_exception(error);
}

void Session::State::read(const v1::Observation& observation) {
  try {
    fleet->read(observation);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(options.endpoint + ": " + error.what());
  }
  tick = observation.tick();
  time = std::chrono::nanoseconds(observation.time_ns());
  epoch.reset();
  if (observation.has_epoch()) epoch = observation.epoch();
  event = is_restored ? Event::restored
          : !has_begun ? Event::init
          : is_reset   ? Event::reset
                       : Event::step;
  has_begun = true;
  is_reset = is_resumed = is_restored = false;
  resumes_in_vain = 0;
  owes = true;
}

void Session::State::read(const v1::End& end) {
  Ending::Reason reason = Ending::Reason::failed;
  if (end.reason() == v1::End::FINISHED) reason = Ending::Reason::finished;
  if (end.reason() == v1::End::INTERRUPTED) reason = Ending::Reason::interrupted;
  ending = Ending{reason, end.message(), end.tick()};
}

void Session::State::read(const v1::Reset& reset) {
  seed = reset.seed();
  read_reset();
}

void Session::State::read_reset() {
  is_reset = was_reset = true;
  is_resumed = false;
  fleet->reset();
}

void Session::State::read(const v1::Restored& restored) {
  snapshot = restored.snapshot();
  is_restored = was_reset = true;
  is_reset = is_resumed = false;
  fleet->reset();
  fleet->resume(restored.commanded());
}

void Session::State::read(const v1::RobotSpawned& robot) {
  constexpr std::size_t most = 10'000;  // a client that does not ask for them keeps no more
  if (spawned.size() < most) {
    spawned.push_back({robot.robot(), robot.controller(), robot.tick()});
  }
}

std::vector<SpawnedRobot> Session::take_spawned() { return std::exchange(state_->spawned, {}); }

void Session::leave() { state_->leave(v1::Leave::DONE, {}); }

void Session::leave_failed(std::string_view message) { state_->leave(v1::Leave::FAILED, message); }

void Session::State::leave(v1::Leave::Reason reason, std::string_view message) {
  if (is_over || connection.is_lost()) return;
  is_over = true;
  for (v1::Leave& failed : fleet->take_failures()) {
    v1::ClientMessage last;
    last.mutable_leave()->Swap(&failed);
    connection.send(last);
  }
  v1::Leave& leave = *outgoing.mutable_leave();
  leave.set_reason(reason);
  leave.set_message(v1::valid_utf8(message));
  fleet->move_log_to(*leave.mutable_log());
  fleet->move_metrics_to(*leave.mutable_metrics());
  connection.send(outgoing);
}

Event Session::event() const noexcept { return state_->event; }
std::uint64_t Session::tick() const noexcept { return state_->tick; }
std::chrono::nanoseconds Session::time() const noexcept { return state_->time; }
const std::optional<Ending>& Session::ending() const noexcept { return state_->ending; }
std::span<Robot> Session::robots() noexcept { return state_->fleet->robots(); }
std::chrono::nanoseconds Session::tick_length() const noexcept { return state_->tick_length; }
std::uint32_t Session::ticks_per_second() const noexcept { return state_->ticks_per_second; }
std::uint64_t Session::seed() const noexcept { return state_->seed; }
const std::string& Session::scene_hash() const noexcept { return state_->scene_hash; }
const std::string& Session::server_version() const noexcept { return state_->server_version; }
const std::string& Session::snapshot() const noexcept { return state_->snapshot; }
const std::string& Session::token() const noexcept { return state_->token; }
std::uint64_t Session::missed() const noexcept { return state_->missed; }
std::uint64_t Session::resumes() const noexcept { return state_->resumes; }

Robot& Session::robot(std::string_view id) {
  for (Robot& robot : robots()) {
    if (robot.id() == id) return robot;
  }
  std::string message = "this session has no robot '" + std::string(id) + "'; it has ";
  for (const Robot& robot : robots()) {
    message += (&robot == robots().data() ? "'" : ", '") + robot.id() + "'";
  }
  throw std::out_of_range(message);
}

}  // namespace ziggurat
