#include "session_devices.h"

#include <algorithm>
#include <stdexcept>

#include "expect.h"

namespace ziggurat {
namespace {

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::array<double, 3> vector_of(const google::protobuf::RepeatedField<double>& values) {
  std::array<double, 3> vector{};
  std::copy_n(values.begin(), std::min<std::size_t>(3, static_cast<std::size_t>(values.size())),
              vector.begin());
  return vector;
}

}  // namespace

Session::Devices::Devices(const v1::Welcome& welcome, std::vector<Robot>& robots)
    : robots_(robots), driving_(welcome, robots) {
  count(welcome);
  traffic.robots.resize(robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const v1::RobotDescription& description = welcome.robots(static_cast<int>(i));
    add_radios(description, robots[i]);
    add_settings(description, robots[i]);
    add_sensors(description, robots[i]);
    cameras_.add(description, robots[i]);
  }
}

/// Gives every array its size: the handles point into them.
void Session::Devices::count(const v1::Welcome& welcome) {
  std::size_t rays = 0;
  for (const v1::RobotDescription& robot : welcome.robots()) {
    for (const auto& led : robot.leds()) led_colors_.initial.push_back(led.color());
    for (const auto& led : robot.directional_leds()) {
      directional_led_colors_.initial.push_back(led.color());
    }
    for (const auto& tag : robot.tags()) tag_payloads_.initial.push_back(tag.payload());
    magnet_currents_.initial.resize(magnet_currents_.initial.size() +
                                    static_cast<std::size_t>(robot.magnets_size()));
    if (robot.range_and_bearing().sends()) {
      range_and_bearing_data_.initial.resize(range_and_bearing_data_.initial.size() +
                                             robot.range_and_bearing().data_size());
    }
    rays += static_cast<std::size_t>(robot.proximity_sensors_size());
  }
  proximity_.resize(rays);
  reset();
}

void Session::Devices::add_radios(const v1::RobotDescription& description, Robot& robot) {
  robot.radios_.resize(static_cast<std::size_t>(description.radios_size()));
  for (std::size_t i = 0; i < robot.radios_.size(); ++i) {
    const v1::RadioDescription& from = description.radios(static_cast<int>(i));
    Radio& radio = robot.radios_[i];
    radio.id_ = from.id();
    radio.range_ = from.range();
    radio.receives_ = from.receives();
    radio.traffic_ = from.sends() ? &traffic : nullptr;
    radio.index_ = static_cast<std::uint32_t>(radios_.size());
    radio.robot_ = robot.position_;
    radios_.push_back(&radio);
  }
  if (description.has_range_and_bearing()) {
    add_range_and_bearing(description.range_and_bearing(), robot);
  }
}

void Session::Devices::add_range_and_bearing(const v1::RangeAndBearingDescription& description,
                                             Robot& robot) {
  RangeAndBearing& device = robot.range_and_bearing_.emplace();
  device.range_ = description.range();
  device.data_size_ = description.data_size();
  device.receives_ = description.receives();
  if (!description.sends()) return;
  device.data_ = std::span(range_and_bearing_data_.values).subspan(made_.data, device.data_size_);
  device.changed_ = &range_and_bearing_data_.changed;
  made_.data += device.data_size_;
}

void Session::Devices::add_settings(const v1::RobotDescription& description, Robot& robot) {
  const auto add_led = [](const v1::LedDescription& from, std::vector<Led>& leds,
                          Settings<std::uint32_t>& colors, std::size_t& made) {
    Led& led = leds.emplace_back();
    led.id_ = from.id();
    led.color_ = &colors.values[made++];
    led.changed_ = &colors.changed;
  };
  for (const auto& from : description.leds()) {
    add_led(from, robot.leds_, led_colors_, made_.leds);
  }
  for (const auto& from : description.directional_leds()) {
    add_led(from, robot.directional_leds_, directional_led_colors_, made_.directional_leds);
  }
  for (const auto& from : description.tags()) {
    Tag& tag = robot.tags_.emplace_back();
    tag.id_ = from.id();
    tag.payload_ = &tag_payloads_.values[made_.tags++];
    tag.changed_ = &tag_payloads_.changed;
  }
  for (const auto& from : description.magnets()) {
    Magnet& magnet = robot.magnets_.emplace_back();
    magnet.id_ = from.id();
    magnet.current_ = &magnet_currents_.values[made_.magnets++];
    magnet.changed_ = &magnet_currents_.changed;
  }
}

void Session::Devices::add_sensors(const v1::RobotDescription& description, Robot& robot) {
  for (const auto& from : description.proximity_sensors()) {
    ProximitySensor& sensor = robot.proximity_.emplace_back();
    sensor.anchor_ = from.anchor();
    sensor.position_ = vector_of(from.position());
    sensor.direction_ = vector_of(from.direction());
    sensor.range_ = from.range();
    if (from.has_angle()) sensor.angle_ = from.angle();
    sensor.reading_ = &proximity_[made_.proximity++];
  }
  if (description.positioning()) positioning_.push_back(&robot.positioning_.emplace());
  if (description.battery()) batteries_.push_back(&robot.battery_.emplace());
}

void Session::Devices::reset() {
  led_colors_.reset();
  directional_led_colors_.reset();
  tag_payloads_.reset();
  magnet_currents_.reset();
  range_and_bearing_data_.reset();
  driving_.reset();
  traffic.clear();
}

void Session::Devices::check(const v1::Observation& observation) const {
  constexpr std::size_t numbers_of_pose = 7;
  constexpr std::size_t numbers_of_battery = 2;
  const auto size = [](int count) { return static_cast<std::size_t>(count); };
  expect(size(observation.proximity_size()), proximity_.size(), "proximity readings");
  expect(size(observation.positioning_size()), numbers_of_pose * positioning_.size(),
         "numbers of poses");
  expect(size(observation.batteries_size()), numbers_of_battery * batteries_.size(),
         "numbers of batteries");
  cameras_.check(observation);
  driving_.check(observation);
  for (const v1::RadioMessage& message : observation.radio_messages()) {
    if (message.radio() < radios_.size() && radios_[message.radio()]->receives()) continue;
    throw std::runtime_error("the server sent a message for radio " +
                             std::to_string(message.radio()) + ", which receives nothing");
  }
  for (const v1::RangeAndBearingPacket& packet : observation.range_and_bearing()) {
    if (packet.robot() < robots_.size() && robots_[packet.robot()].range_and_bearing_ &&
        robots_[packet.robot()].range_and_bearing_->receives()) {
      continue;
    }
    throw std::runtime_error("the server sent a range-and-bearing packet for robot " +
                             std::to_string(packet.robot()) + ", which receives none");
  }
}

void Session::Devices::read(const v1::Observation& observation) {
  check(observation);
  std::copy(observation.proximity().begin(), observation.proximity().end(), proximity_.begin());
  const double* number = observation.positioning().data();
  for (Positioning* sensor : positioning_) {
    std::copy_n(number, 3, sensor->position.begin());
    std::copy_n(number + 3, 4, sensor->orientation.begin());
    number += 7;
  }
  number = observation.batteries().data();
  for (Battery* sensor : batteries_) {
    sensor->available_charge = *number++;
    sensor->time_left = *number++;
  }
  read_radio_messages(observation);
  read_packets(observation);
  cameras_.read(observation);
  driving_.read(observation);
}

void Session::Devices::read_radio_messages(const v1::Observation& observation) {
  for (Radio* radio : radios_) radio->received_.clear();
  for (const v1::RadioMessage& message : observation.radio_messages()) {
    radios_[message.radio()]->received_.push_back(bytes_of(message.payload()));
  }
}

void Session::Devices::read_packets(const v1::Observation& observation) {
  for (Robot& robot : robots_) {
    if (robot.range_and_bearing_) robot.range_and_bearing_->packets_.clear();
  }
  for (const v1::RangeAndBearingPacket& packet : observation.range_and_bearing()) {
    robots_[packet.robot()].range_and_bearing_->packets_.push_back(
        {packet.range(), packet.horizontal_bearing(), packet.vertical_bearing(),
         bytes_of(packet.data())});
  }
}

void Session::Devices::write(v1::Command& command) {
  const auto add = [](auto& settings, auto& to) {
    if (settings.changed) to.Add(settings.values.begin(), settings.values.end());
  };
  add(led_colors_, *command.mutable_led_colors());
  add(directional_led_colors_, *command.mutable_directional_led_colors());
  add(magnet_currents_, *command.mutable_magnet_currents());
  if (tag_payloads_.changed) {
    for (const std::string& payload : tag_payloads_.values) command.add_tag_payloads(payload);
  }
  if (range_and_bearing_data_.changed) {
    command.mutable_range_and_bearing_data()->assign(range_and_bearing_data_.values.begin(),
                                                     range_and_bearing_data_.values.end());
  }
  driving_.write(command);
  command.mutable_radio_messages()->Swap(&traffic.messages);
}

void Session::Devices::repeat() {
  led_colors_.changed = true;
  directional_led_colors_.changed = true;
  tag_payloads_.changed = true;
  magnet_currents_.changed = true;
  range_and_bearing_data_.changed = true;
  driving_.repeat();
}

void Session::Devices::sent(v1::Command& command) {
  command.mutable_radio_messages()->Swap(&traffic.messages);
  traffic.clear();
  led_colors_.changed = false;
  directional_led_colors_.changed = false;
  tag_payloads_.changed = false;
  magnet_currents_.changed = false;
  range_and_bearing_data_.changed = false;
  driving_.sent();
}

}  // namespace ziggurat
