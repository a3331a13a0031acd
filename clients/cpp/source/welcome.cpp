// How a session begins: Hello, and what Welcome says.

#include <algorithm>
#include <map>

#include "session_state.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {
namespace {

constexpr std::uint32_t version_major = 1;
constexpr std::uint32_t version_minor = 0;

JointMode mode_of(v1::JointDescription::Mode mode) {
  switch (mode) {
    case v1::JointDescription::POSITION:
      return JointMode::position;
    case v1::JointDescription::VELOCITY:
      return JointMode::velocity;
    default:
      return JointMode::disabled;
  }
}

void fill(const Options& options, v1::Hello& hello) {
  hello.mutable_version()->set_major(version_major);
  hello.mutable_version()->set_minor(version_minor);
  hello.set_role(v1::ROLE_CONTROLLER);
  for (const std::string& robot : options.robots) hello.add_robots(v1::valid_utf8(robot));
  hello.set_controller(v1::valid_utf8(options.controller));
  hello.set_lua_only(options.lua_only);
  hello.set_client_name(v1::valid_utf8(options.name));
  hello.set_client_version(v1::valid_utf8(options.version));
  if (options.robots.empty() && options.controller.empty() && !options.lua_only) {
    hello.add_robots("*");
  }
  hello.set_session_token(options.session_token);
  hello.set_takeover(options.takeover);
  if (options.deadline) {
    v1::DeadlinePolicy& policy = *hello.mutable_deadline_policy();
    policy.set_action(static_cast<v1::DeadlinePolicy::Action>(options.deadline->action));
    policy.set_wall_deadline_ms(static_cast<std::uint32_t>(options.deadline->after.count()));
    policy.set_miss_budget(options.deadline->miss_budget);
  }
}

/// What is allocated because a number says so.
void check_sizes(const v1::Welcome& welcome, const std::string& endpoint) {
  constexpr std::uint32_t most_data_bytes = 65'536;  // of a packet, as in scenes
  for (const v1::RobotDescription& robot : welcome.robots()) {
    const std::uint32_t bytes = robot.range_and_bearing().data_size();
    if (bytes <= most_data_bytes) continue;
    throw ConnectionError(endpoint + ": the server announced range-and-bearing packets of " +
                          std::to_string(bytes) + " bytes for robot '" + robot.id() + "'; " +
                          std::to_string(most_data_bytes) + " are possible");
  }
}

}  // namespace

void Session::State::open() {
  fill(options, *outgoing.mutable_hello());
  connection.send(outgoing);
  for (;;) {
    const auto kind = connection.receive(options.connect_timeout, options.is_interrupted);
    if (!kind && is_interrupted()) {
      throw ConnectionError("interrupted while waiting for a welcome at " + options.endpoint);
    }
    if (!kind) {
      throw ConnectionError("no server welcomed us at " + options.endpoint + " within " +
                            std::to_string(options.connect_timeout.count()) + " ms");
    }
    switch (*kind) {
      case Connection::Kind::kWelcome:
        read(connection.message().welcome());
        connection.expect_open();
        return;
      case Connection::Kind::kRefusal: {
        const v1::Refusal& refusal = connection.message().refusal();
        throw to_exception(refusal.error(), refusal.holder());
      }
      case Connection::Kind::kError:
        throw to_exception(connection.message().error());
      default:
        break;  // still loading, or news of a later version
    }
  }
}

void Session::State::read(const v1::Welcome& welcome) {
  check_sizes(welcome, options.endpoint);
  tick_length = std::chrono::nanoseconds(welcome.tick_ns());
  ticks_per_second = welcome.ticks_per_second();
  seed = welcome.seed();
  scene_hash = welcome.scene_hash();
  server_version = welcome.server_version();
  token = welcome.session_token();
  log.max_bytes = std::max<std::size_t>(welcome.max_message_bytes() / 4, std::size_t{1} << 16);
  std::size_t reading_count = 0;
  std::size_t target_count = 0;
  for (const v1::RobotDescription& robot : welcome.robots()) {
    reading_count += static_cast<std::size_t>(robot.joint_sensors_size());
    target_count += static_cast<std::size_t>(robot.joint_actuators_size());
  }
  readings.assign(reading_count, 0.0);
  targets.assign(target_count, 0.0);

  const double* reading = readings.data();
  double* target = targets.data();
  robots.resize(static_cast<std::size_t>(welcome.robots_size()));
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const v1::RobotDescription& description = welcome.robots(static_cast<int>(i));
    Robot& robot = robots[i];
    robot.id_ = description.id();
    robot.controller_ = description.controller();
    robot.script_ = description.script();
    for (const v1::Parameter& param : description.params()) {
      robot.params_.emplace_back(param.name(), param.value());
    }
    robot.position_ = static_cast<std::uint32_t>(i);
    robot.log_ = &log;
    add_joints(description, robot, reading, target);
  }
  devices.emplace(welcome, robots);
  devices->traffic.max_bytes = welcome.max_message_bytes() / 2;
}

/// Sensors and actuators of the same id are one joint.
void Session::State::add_joints(const v1::RobotDescription& description, Robot& robot,
                                const double*& reading, double*& target) {
  std::map<std::string, std::size_t> known;
  for (const v1::JointDescription& sensor : description.joint_sensors()) {
    known.emplace(sensor.id(), robot.joints_.size());
    Joint& joint = robot.joints_.emplace_back();
    joint.id_ = sensor.id();
    joint.encoder_mode_ = mode_of(sensor.mode());
    joint.reading_ = reading++;
  }
  for (const v1::JointDescription& actuator : description.joint_actuators()) {
    const auto [found, is_new] = known.emplace(actuator.id(), robot.joints_.size());
    if (is_new) robot.joints_.emplace_back();
    Joint& joint = robot.joints_[found->second];
    joint.id_ = actuator.id();
    joint.motor_mode_ = mode_of(actuator.mode());
    joint.max_impulse_ = actuator.max_impulse();
    joint.target_ = target++;
    joint.changed_ = &changed;
  }
}

ProtocolError to_exception(const v1::Error& error, const std::string& holder) {
  ProtocolError::Details details;
  details.code = v1::Error::Code_Name(error.code());
  if (details.code.empty()) details.code = "CODE_" + std::to_string(error.code());
  details.retryable = error.retryable();
  details.tick = error.tick();
  details.robot = error.robot();
  details.field = error.field();
  details.holder = holder;
  return ProtocolError(details.code + ": " + error.message(), details);
}

}  // namespace ziggurat
