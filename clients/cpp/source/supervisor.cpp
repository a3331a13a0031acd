// SPDX-License-Identifier: MIT
#include "ziggurat/supervisor.h"

#include <algorithm>
#include <cctype>

#include "asked_place.h"
#include "connection.h"
#include "convert.h"
#include "driven.h"
#include "session_core.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/json.h"

namespace ziggurat {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

Latency latency_of(const v1::Latency& from) { return {from.p50(), from.p99(), from.max()}; }

std::string policy_of(const v1::DeadlinePolicy& from) {
  if (from.action() == v1::DeadlinePolicy::ACTION_UNSPECIFIED) return "by robot";
  std::string text = lower(v1::DeadlinePolicy::Action_Name(from.action()));
  if (from.action() == v1::DeadlinePolicy::WAIT) return text;
  text += " after " + std::to_string(from.wall_deadline_ms()) + " ms";
  if (from.miss_budget() > 0) text += ", budget " + std::to_string(from.miss_budget());
  return text;
}

/// A later version of the protocol may have more roles.
std::string role_of(v1::Role role) {
  constexpr std::size_t prefix = std::string_view("ROLE_").size();
  if (!v1::Role_IsValid(role)) return "role " + std::to_string(role);
  return lower(v1::Role_Name(role).substr(prefix));
}

SessionStatus session_of(const v1::SessionStatus& from) {
  SessionStatus to;
  to.client = from.client();
  to.role = role_of(from.role());
  to.state = lower(v1::SessionStatus::State_Name(from.state()));
  to.robots.assign(from.robots().begin(), from.robots().end());
  to.tick = from.tick();
  to.waiting = from.wall_waiting_s();
  to.last_message = from.wall_last_message_s();
  to.latency = latency_of(from.wall_latency());
  to.misses = from.misses();
  to.policy = policy_of(from.deadline_policy());
  to.director = from.director();
  return to;
}

ServerStatus status_of(const v1::Status& from) {
  ServerStatus to;
  to.tick = from.tick();
  to.time = std::chrono::nanoseconds(from.time_ns());
  to.phase = lower(v1::Status::Phase_Name(from.phase()));
  to.hardware_in_the_loop = from.mode() == v1::MODE_HARDWARE_IN_THE_LOOP;
  to.seed = from.seed();
  to.scene = from.scene();
  to.scene_hash = from.scene_hash();
  to.last_tick = from.last_tick();
  for (const v1::SessionStatus& session : from.sessions()) {
    to.sessions.push_back(session_of(session));
  }
  to.free_robots.assign(from.free_robots().begin(), from.free_robots().end());
  to.gone_robots.assign(from.gone_robots().begin(), from.gone_robots().end());
  to.free_directors.assign(from.free_directors().begin(), from.free_directors().end());
  for (const v1::PhaseBudget& phase : from.budget()) {
    to.budget.push_back({phase.phase(), latency_of(phase.wall())});
  }
  to.uptime = from.wall_uptime_s();
  to.solver = {from.solver().islands(), from.solver().not_converged(),
               from.solver().worst_residual()};
  return to;
}

EntityState entity_of(const v1::States::Entity& from) {
  EntityState to;
  to.id = from.id();
  copy(from.position(), to.position);
  copy(from.orientation(), to.orientation);
  for (const v1::States::Link& link : from.links()) {
    EntityState::Link& state = to.links.emplace_back();
    state.id = link.id();
    copy(link.position(), state.position);
    copy(link.orientation(), state.orientation);
    copy(link.velocity(), state.velocity);
    copy(link.angular_velocity(), state.angular_velocity);
  }
  to.led_colors.assign(from.led_colors().begin(), from.led_colors().end());
  return to;
}

SessionOptions where(const SupervisorOptions& wanted) {
  SessionOptions options;
  options.endpoint = wanted.endpoint;
  options.server_key = wanted.server_key;
  options.curve_secret = wanted.curve_secret;
  return options;
}

}  // namespace

struct Supervisor::State {
  explicit State(const SupervisorOptions& wanted) : options(wanted), connection(where(wanted)) {}

  void open();
  /// Sends the current request and waits for its answer. @throws ProtocolError if it was refused
  const v1::Response& ask();
  v1::Request& request() {
    v1::Request& fresh = *outgoing.mutable_request();
    fresh.Clear();
    fresh.set_id(++last_id);
    return fresh;
  }
  /// Names the sessions that can't answer while this thread waits.
  void add_held_up() {
    for (std::string& id : driven_here(options.endpoint))
      outgoing.mutable_request()->add_held_up(std::move(id));
  }
  /// @param whole  time-out of which there is this rest; none = forever
  Connection::Kind hear(std::optional<std::chrono::milliseconds> rest,
                        std::optional<std::chrono::milliseconds> whole, const char* what);

  SupervisorOptions options;
  Connection connection;
  v1::ClientMessage outgoing;
  std::uint64_t last_id = 0;
  std::string json;  // of the last answer
};

Connection::Kind Supervisor::State::hear(std::optional<std::chrono::milliseconds> rest,
                                         std::optional<std::chrono::milliseconds> whole,
                                         const char* what) {
  const auto kind = connection.receive(rest, options.is_interrupted);
  if (!kind) {
    const bool interrupted = options.is_interrupted && options.is_interrupted();
    throw ConnectionError(
        std::string("no ") + what + " from " + options.endpoint +
        (interrupted ? ": interrupted" : " after " + std::to_string(whole->count()) + " ms"));
  }
  if (*kind == Connection::Kind::kError) throw to_exception(connection.message().error());
  if (*kind == Connection::Kind::kEnd) {
    throw ConnectionError(options.endpoint + ": the run has ended");
  }
  return *kind;
}

void Supervisor::State::open() {
  v1::Hello& hello = *outgoing.mutable_hello();
  hello.mutable_version()->set_major(version_major);
  hello.mutable_version()->set_minor(version_minor);
  hello.set_role(options.only_observes ? v1::ROLE_OBSERVER : v1::ROLE_SUPERVISOR);
  hello.set_client_name(v1::valid_utf8(options.name));
  hello.set_client_version(v1::valid_utf8(options.version));
  connection.send(outgoing);
  for (;;) {
    const auto kind = hear(options.connect_timeout, options.connect_timeout, "welcome");
    if (kind == Connection::Kind::kRefusal) {
      throw to_exception(connection.message().refusal().error());
    }
    if (kind == Connection::Kind::kWelcome) {
      return check_welcome(connection.message().welcome(), options.endpoint);
    }
  }
}

const v1::Response& Supervisor::State::ask() {
  using std::chrono::milliseconds;
  using Clock = std::chrono::steady_clock;
  connection.send(outgoing);
  // Heartbeats come in between: they do not extend the time-out.
  const auto end = Clock::now() + options.answer_timeout.value_or(milliseconds{0});
  auto rest = options.answer_timeout;
  for (;;) {
    const auto kind = hear(rest, options.answer_timeout, "answer");
    if (rest) rest = std::max(std::chrono::ceil<milliseconds>(end - Clock::now()), milliseconds{0});
    if (kind != Connection::Kind::kResponse) continue;
    const v1::Response& response = connection.message().response();
    if (response.id() != last_id) continue;
    if (response.has_error()) throw to_exception(response.error());
    return response;
  }
}

Supervisor::Supervisor(const SupervisorOptions& options)
    : state_(std::make_unique<State>(options)) {
  state_->open();
}

Supervisor::~Supervisor() {
  try {
    state_->outgoing.mutable_leave()->set_reason(v1::Leave::DONE);
    state_->connection.send(state_->outgoing);
  } catch (const std::exception&) {
    // The server is gone.
  }
}

ServerStatus Supervisor::status() {
  state_->request().mutable_status();
  const v1::Response& response = state_->ask();
  state_->json = v1::to_json(response.status());
  return status_of(response.status());
}

std::uint64_t Supervisor::pause() {
  state_->request().mutable_pause();
  state_->add_held_up();
  return state_->ask().tick();
}

std::uint64_t Supervisor::resume() {
  state_->request().mutable_resume();
  return state_->ask().tick();
}

std::uint64_t Supervisor::step(std::uint64_t ticks) {
  state_->request().mutable_step()->set_ticks(ticks);
  state_->add_held_up();
  return state_->ask().tick();
}

void Supervisor::reset(std::optional<std::uint64_t> seed) {
  v1::ResetRequest& reset = *state_->request().mutable_reset();
  if (seed) reset.set_seed(*seed);
  state_->ask();
}

std::uint64_t Supervisor::snapshot(std::string_view name) {
  state_->request().mutable_snapshot()->set_name(v1::valid_utf8(std::string(name)));
  return state_->ask().tick();
}

std::uint64_t Supervisor::restore(std::string_view name) {
  state_->request().mutable_restore()->set_name(v1::valid_utf8(std::string(name)));
  return state_->ask().tick();
}

std::uint64_t Supervisor::spawn(std::string_view xml) {
  state_->request().mutable_spawn()->set_xml(v1::valid_utf8(std::string(xml)));
  return state_->ask().tick();
}

std::uint64_t Supervisor::remove(std::string_view entity) {
  state_->request().mutable_remove()->set_entity(v1::valid_utf8(std::string(entity)));
  return state_->ask().tick();
}

std::uint64_t Supervisor::move(std::string_view entity, const std::array<double, 3>& position,
                               const std::optional<std::array<double, 4>>& orientation, Onto onto) {
  v1::MoveRequest& move = *state_->request().mutable_move();
  move.set_entity(v1::valid_utf8(std::string(entity)));
  for (const double value : position) move.add_position(value);
  if (orientation) {
    for (const double value : *orientation) move.add_orientation(value);
  }
  move.set_may_overlap(onto == Onto::others);
  return state_->ask().tick();
}

std::uint64_t Supervisor::set_joint(std::string_view entity, std::string_view joint,
                                    double position, double velocity) {
  v1::SetJointRequest& set = *state_->request().mutable_set_joint();
  set.set_entity(v1::valid_utf8(entity));
  set.set_joint(v1::valid_utf8(joint));
  set.set_position(position);
  set.set_velocity(velocity);
  return state_->ask().tick();
}

std::optional<std::string> Supervisor::overlapped(
    std::string_view what, const std::array<double, 3>& position,
    const std::optional<std::array<double, 4>>& orientation) {
  ask_for_place(what, position, orientation, *state_->request().mutable_is_free());
  return overlapped_in(state_->ask());
}

WorldStates Supervisor::read(std::span<const std::string> entities) {
  v1::ReadRequest& read = *state_->request().mutable_read();
  for (const std::string& entity : entities) read.add_entities(v1::valid_utf8(entity));
  const v1::Response& response = state_->ask();
  state_->json = v1::to_json(response.states());
  WorldStates states{response.tick(), response.states().hash(), {}};
  for (const v1::States::Entity& entity : response.states().entities()) {
    states.entities.push_back(entity_of(entity));
  }
  return states;
}

void Supervisor::shutdown(std::string_view reason) {
  v1::ShutdownRequest& request = *state_->request().mutable_shutdown();
  if (!reason.empty()) request.set_reason(v1::valid_utf8(reason));
  state_->ask();
}

std::string Supervisor::last_answer_json() const { return state_->json; }

}  // namespace ziggurat
