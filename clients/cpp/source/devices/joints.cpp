// SPDX-License-Identifier: MIT
#include <map>

#include "layout.h"
#include "text/printable.h"

namespace ziggurat {
namespace {

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

double reading_of(bool has_sensor, double reading, const char* mode, std::string_view id) {
  if (has_sensor) return reading;
  throw std::logic_error("joint '" + text::printable_part(id) + "' has no sensor in mode " + mode +
                         ": the controller's <sensors> do not list it");
}

}  // namespace

double Joint::position() const { return reading_of(has_position_, position_, "position", id_); }
double Joint::velocity() const { return reading_of(has_velocity_, velocity_, "velocity", id_); }

/// Sensors and an actuator with the same id are one joint.
void Layout::add_joints() {
  auto& readings = add(Readings<double>("joint readings", &v1::Observation::joint_readings));
  auto& targets = add(Settings<double>(&v1::Command::mutable_joint_targets));
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    to.joints_.reserve(size(from.joint_sensors_size() + from.joint_actuators_size()));
    std::map<std::string, std::size_t> known;
    for (const v1::JointDescription& sensor : from.joint_sensors()) {
      const auto [found, is_new] = known.emplace(sensor.id(), to.joints_.size());
      if (is_new) to.joints_.emplace_back();
      Joint& joint = to.joints_[found->second];
      joint.id_ = sensor.id();
      const JointMode mode = mode_of(sensor.mode());
      if (!joint.has_encoder_) joint.encoder_mode_ = mode;
      joint.has_encoder_ = true;
      joint.has_position_ |= mode == JointMode::position;
      joint.has_velocity_ |= mode == JointMode::velocity;
      readings.add(mode == JointMode::position   ? joint.position_
                   : mode == JointMode::velocity ? joint.velocity_
                                                 : joint.other_);
    }
    for (const v1::JointDescription& actuator : from.joint_actuators()) {
      const auto [found, is_new] = known.emplace(actuator.id(), to.joints_.size());
      if (is_new) to.joints_.emplace_back();
      Joint& joint = to.joints_[found->second];
      joint.id_ = actuator.id();
      joint.motor_mode_ = mode_of(actuator.mode());
      joint.max_impulse_ = actuator.max_impulse();
      joint.target_ = &targets.add(0.0);
      joint.changed_ = &targets.changed();
    }
  });
}

void Joint::set_target(double target) {
  if (target_ == nullptr) {
    throw std::logic_error("joint '" + text::printable_part(id_) +
                           "' has no motor: the controller's <actuators> do not list it");
  }
  check_finite(target, "the target of joint", id_);
  *target_ = target;
  *changed_ = true;
}

}  // namespace ziggurat
