// Wheels and turrets that are set.

#include <cmath>
#include <stdexcept>
#include <string>

#include "ziggurat/turret.h"
#include "ziggurat/wheels.h"

namespace ziggurat {
namespace {

void check_drives(bool drives, const char* what) {
  if (drives) return;
  throw std::logic_error(std::string("the robot does not drive its ") + what +
                         ": the controller's <actuators> do not list it");
}

void check_finite(double value, const char* what) {
  if (std::isfinite(value)) return;
  throw std::invalid_argument(std::string(what) + " is " + std::to_string(value) +
                              "; it must be finite");
}

}  // namespace

void Wheels::set_velocity(double left, double right) {
  check_drives(drives(), "wheels");
  check_finite(left, "the speed of the left wheel");
  check_finite(right, "the speed of the right wheel");
  velocities_[0] = left;
  velocities_[1] = right;
  *changed_ = true;
}

void Turret::set_mode(TurretMode mode) {
  check_drives(drives(), "turret");
  *mode_ = mode;
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
