#include "program/exchange.h"

#include <algorithm>
#include <stdexcept>

namespace ziggurat::lua {

namespace {

void describe_joints(ziggurat::Robot& robot, ScriptedRobot& scripted) {
  for (const ziggurat::Joint& from : robot.joints()) {
    Joint& joint = scripted.joints.emplace_back();
    joint.id = from.id();
    joint.has_encoder = from.has_encoder();
    joint.has_motor = from.has_motor();
  }
}

void describe_radios(ziggurat::Robot& robot, ScriptedRobot& scripted) {
  scripted.radio_limits = {ziggurat::Radio::max_message_bytes, ziggurat::Radio::max_bytes_per_robot,
                           ziggurat::Radio::max_messages_per_robot};
  for (const ziggurat::Radio& from : robot.radios()) {
    Radio& radio = scripted.radios.emplace_back();
    radio.id = from.id();
    radio.has_receiver = from.receives();
    radio.has_transmitter = from.sends();
  }
  if (const ziggurat::RangeAndBearing* from = robot.range_and_bearing()) {
    RangeAndBearing& device = scripted.range_and_bearing.emplace();
    device.has_receiver = from->receives();
    device.has_transmitter = from->sends();
  }
}

void describe_cameras(const ziggurat::Robot& robot, ScriptedRobot& scripted) {
  for (const ziggurat::Camera& from : robot.cameras()) {
    Camera& camera = scripted.cameras.emplace_back();
    camera.id = from.id();
    camera.anchor = from.anchor();
    camera.position = from.position();
    camera.orientation = from.orientation();
    camera.near = from.near();
    camera.far = from.far();
    camera.focal_length = from.focal_length();
    camera.principal_point = from.principal_point();
    camera.resolution = {from.width(), from.height()};
    camera.detects_leds = from.detects_leds();
    camera.detects_directional_leds = from.detects_directional_leds();
    camera.detects_tags = from.detects_tags();
    camera.takes_images = from.takes_images();
  }
}

void describe_proximity(const ziggurat::Robot& robot, ScriptedRobot& scripted) {
  const auto sensors = robot.proximity_sensors();
  scripted.proximity.resize(sensors.size());
  const auto tells_angle = [](const auto& sensor) { return sensor.angle().has_value(); };
  if (!std::ranges::all_of(sensors, tells_angle)) return;
  for (const auto& sensor : sensors) scripted.proximity_angles.push_back(*sensor.angle());
}

void describe_driving(ziggurat::Robot& robot, ScriptedRobot& scripted) {
  if (const ziggurat::Wheels* from = robot.wheels()) {
    Wheels& wheels = scripted.wheels.emplace();
    wheels.axle_length = from->axle_length();
    wheels.has_sensor = from->measures();
    wheels.has_actuator = from->drives();
  }
  if (const ziggurat::Turret* from = robot.turret()) {
    Turret& turret = scripted.turret.emplace();
    turret.has_encoder = from->measures();
    turret.has_actuator = from->drives();
  }
}

void sense_leds(std::span<const ziggurat::Camera::LedReading> from, std::vector<SeenLed>& to) {
  to.clear();
  for (const auto& led : from) {
    to.push_back({{led.color.red, led.color.green, led.color.blue}, led.center});
  }
}

void sense_cameras(const ziggurat::Robot& from, ScriptedRobot& to) {
  auto camera = to.cameras.begin();
  for (const ziggurat::Camera& sensed : from.cameras()) {
    sense_leds(sensed.leds(), camera->leds);
    sense_leds(sensed.directional_leds(), camera->directional_leds);
    camera->tags.clear();
    for (const auto& tag : sensed.tags()) {
      camera->tags.push_back({tag.payload, tag.center, tag.corners});
    }
    camera->image = sensed.image();
    ++camera;
  }
}

void sense_driving(ziggurat::Robot& from, ScriptedRobot& to) {
  if (const ziggurat::Wheels* sensed = from.wheels()) {
    const ziggurat::Wheels::Reading& reading = sensed->reading();
    to.wheels->velocity_left = reading.velocity_left;
    to.wheels->velocity_right = reading.velocity_right;
    to.wheels->distance_left = reading.distance_left;
    to.wheels->distance_right = reading.distance_right;
  }
  if (const ziggurat::Turret* sensed = from.turret()) to.turret->rotation = sensed->rotation();
}

void sense_radios(ziggurat::Robot& from, ScriptedRobot& to) {
  auto radio = to.radios.begin();
  for (const ziggurat::Radio& sensed : from.radios()) (radio++)->received = sensed.received();
  const ziggurat::RangeAndBearing* const device = from.range_and_bearing();
  if (device == nullptr) return;
  to.range_and_bearing->packets.clear();
  for (const auto& packet : device->packets()) {
    to.range_and_bearing->packets.push_back(
        {packet.range, packet.horizontal_bearing, packet.vertical_bearing, packet.data});
  }
  // A reset of the world changes it.
  to.range_and_bearing->data.value.assign(device->data().begin(), device->data().end());
}

void send(Outgoing& from, ziggurat::Radio& to) {
  const Bytes all(from.bytes);
  std::size_t begin = 0;
  for (const std::size_t end : from.ends) {
    to.send(all.subspan(begin, end - begin));
    begin = end;
  }
}

void act_radios(ScriptedRobot& from, ziggurat::Robot& to) {
  auto radio = to.radios().begin();
  for (Radio& commanded : from.radios) {
    send(commanded.sent, *radio++);
    commanded.sent.clear();
  }
  if (!from.range_and_bearing || !from.range_and_bearing->data.is_fresh) return;
  to.range_and_bearing()->set_data(from.range_and_bearing->data.value);
  from.range_and_bearing->data.is_fresh = false;
}

/// Hands over what is fresh; the lists stand in the same order.
template <typename Commanded, typename Devices, typename Set>
void act_settings(Commanded& commanded, Devices devices, Set set) {
  auto device = devices.begin();
  for (auto& setting : commanded) {
    if (setting.is_fresh) set(*device, setting.value);
    setting.is_fresh = false;
    ++device;
  }
}

/// Hands over the setting, if it is fresh.
template <typename T, typename Set>
void act_setting(Setting<T>& setting, Set set) {
  if (setting.is_fresh) set(setting.value);
  setting.is_fresh = false;
}

ziggurat::TurretMode mode_of(TurretMode mode) {
  switch (mode) {
    case TurretMode::passive:
      break;
    case TurretMode::position:
      return ziggurat::TurretMode::position;
    case TurretMode::speed:
      return ziggurat::TurretMode::speed;
  }
  return ziggurat::TurretMode::passive;
}

void act_driving(ScriptedRobot& from, ziggurat::Robot& to) {
  if (from.wheels) {
    act_setting(from.wheels->velocities, [&](const std::array<double, 2>& velocities) {
      to.wheels()->set_velocity(velocities[0], velocities[1]);
    });
  }
  if (!from.turret) return;
  ziggurat::Turret& turret = *to.turret();
  act_setting(from.turret->mode, [&](TurretMode mode) { turret.set_mode(mode_of(mode)); });
  act_setting(from.turret->target, [&](double rotation) { turret.set_rotation(rotation); });
  act_setting(from.turret->speed, [&](double speed) { turret.set_rotation_speed(speed); });
}

}  // namespace

ScriptedRobot describe(ziggurat::Robot& robot) {
  ScriptedRobot scripted;
  scripted.id = robot.id();
  scripted.params = robot.params();
  describe_joints(robot, scripted);
  describe_radios(robot, scripted);
  scripted.leds.resize(robot.leds().size());
  scripted.directional_leds.resize(robot.directional_leds().size());
  scripted.tags.resize(robot.tags().size());
  for (const ziggurat::Magnet& from : robot.magnets()) scripted.magnets.push_back({from.id(), {}});
  describe_proximity(robot, scripted);
  if (robot.positioning() != nullptr) scripted.positioning.emplace();
  if (robot.battery() != nullptr) scripted.battery.emplace();
  describe_cameras(robot, scripted);
  describe_driving(robot, scripted);
  return scripted;
}

void sense(ziggurat::Robot& from, ScriptedRobot& to) {
  auto joint = to.joints.begin();
  for (const ziggurat::Joint& sensed : from.joints()) (joint++)->encoder = sensed.encoder();
  sense_radios(from, to);
  auto reading = to.proximity.begin();
  for (const auto& sensor : from.proximity_sensors()) *reading++ = sensor.reading();
  if (const auto* sensor = from.positioning())
    *to.positioning = {sensor->position, sensor->orientation};
  if (const auto* sensor = from.battery())
    *to.battery = {sensor->available_charge, sensor->time_left};
  sense_cameras(from, to);
  sense_driving(from, to);
}

Failure act(ScriptedRobot& from, ziggurat::Robot& to) {
  auto commanded = to.joints().begin();
  for (Joint& joint : from.joints) {
    if (joint.is_target_fresh) commanded->set_target(joint.target);
    joint.is_target_fresh = false;
    ++commanded;
  }
  const auto set_color = [](ziggurat::Led& led, const Color& color) {
    led.set_color({color.red, color.green, color.blue});
  };
  act_settings(from.leds, to.leds(), set_color);
  act_settings(from.directional_leds, to.directional_leds(), set_color);
  act_settings(from.tags, to.tags(),
               [](ziggurat::Tag& tag, const std::string& payload) { tag.set_payload(payload); });
  auto magnet = to.magnets().begin();
  for (Magnet& set : from.magnets) {
    if (set.current.is_fresh) magnet->set_current(set.current.value);
    set.current.is_fresh = false;
    ++magnet;
  }
  act_driving(from, to);
  try {
    act_radios(from, to);
  } catch (const std::length_error& error) {
    // All robots of the session together send too much.
    return error.what();
  }
  return std::nullopt;
}

bool hand_over_log(ScriptedRobot& from, ziggurat::Robot& to) {
  bool fits = true;
  try {
    for (const LogLine& line : from.log.lines) {
      if (line.is_error) {
        to.log_error(line.text);
      } else {
        to.log(line.text);
      }
    }
  } catch (const std::length_error&) {
    fits = false;
  }
  from.log.clear();
  return fits;
}

}  // namespace ziggurat::lua
