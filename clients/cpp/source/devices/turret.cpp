// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {
namespace {

v1::TurretMode mode_of(TurretMode mode) {
  switch (mode) {
    case TurretMode::passive:
      return v1::TURRET_PASSIVE;
    case TurretMode::position:
      return v1::TURRET_POSITION;
    case TurretMode::speed:
      return v1::TURRET_SPEED;
  }
  return v1::TURRET_MODE_UNSPECIFIED;
}

}  // namespace

void Layout::add_turrets() {
  auto& readings =
      add(Readings<double>("rotations of turrets", &v1::Observation::turret_rotations));
  auto& modes = add(Settings<int>(&v1::Command::mutable_turret_modes));
  auto& rotations = add(Settings<double>(&v1::Command::mutable_turret_rotations));
  auto& speeds = add(Settings<double>(&v1::Command::mutable_turret_speeds));
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    if (!from.has_turret()) return;
    Turret& turret = to.turret_.emplace();
    turret.measures_ = from.turret().measures();
    if (turret.measures_) readings.add(turret.rotation_);
    if (!from.turret().drives()) return;
    turret.mode_ = &modes.add(v1::TURRET_PASSIVE);
    turret.target_ = &rotations.add(0.0);
    turret.speed_ = &speeds.add(0.0);
    turret.mode_changed_ = &modes.changed();
    turret.target_changed_ = &rotations.changed();
    turret.speed_changed_ = &speeds.changed();
  });
}

void Turret::set_mode(TurretMode mode) {
  check_drives(drives(), "turret");
  *mode_ = mode_of(mode);
  *mode_changed_ = true;
}

void Turret::set_rotation(double rotation) {
  check_drives(drives(), "turret");
  check_finite(rotation, "the rotation of the turret");
  *target_ = rotation;
  *target_changed_ = true;
}

void Turret::set_rotation_speed(double speed) {
  check_drives(drives(), "turret");
  check_finite(speed, "the speed of the turret");
  *speed_ = speed;
  *speed_changed_ = true;
}

}  // namespace ziggurat
