#include "session_driving.h"

#include "expect.h"

namespace ziggurat {
namespace {

constexpr std::size_t numbers_of_wheels = 4;

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

Session::Driving::Driving(const v1::Welcome& welcome, std::vector<Robot>& robots) {
  std::size_t wheels = 0;
  std::size_t turrets = 0;
  for (const v1::RobotDescription& robot : welcome.robots()) {
    if (robot.wheels().drives()) ++wheels;
    if (robot.turret().drives()) ++turrets;
  }
  velocities_.initial.resize(2 * wheels);
  modes_.initial.resize(turrets);
  rotations_.initial.resize(turrets);
  speeds_.initial.resize(turrets);
  reset();

  double* velocity = velocities_.values.data();
  std::size_t turret = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const v1::RobotDescription& description = welcome.robots(static_cast<int>(i));
    if (description.has_wheels()) {
      Wheels& made = robots[i].wheels_.emplace();
      made.axle_length_ = description.wheels().axle_length();
      made.measures_ = description.wheels().measures();
      if (made.measures_) wheels_.push_back(&made);
      if (description.wheels().drives()) {
        made.velocities_ = velocity;
        made.changed_ = &velocities_.changed;
        velocity += 2;
      }
    }
    if (description.has_turret()) {
      Turret& made = robots[i].turret_.emplace();
      made.measures_ = description.turret().measures();
      if (made.measures_) turrets_.push_back(&made);
      if (description.turret().drives()) {
        made.mode_ = &modes_.values[turret];
        made.target_ = &rotations_.values[turret];
        made.speed_ = &speeds_.values[turret];
        made.mode_changed_ = &modes_.changed;
        made.target_changed_ = &rotations_.changed;
        made.speed_changed_ = &speeds_.changed;
        ++turret;
      }
    }
  }
}

void Session::Driving::check(const v1::Observation& observation) const {
  expect(static_cast<std::size_t>(observation.wheels_size()), numbers_of_wheels * wheels_.size(),
         "numbers of wheels");
  expect(static_cast<std::size_t>(observation.turret_rotations_size()), turrets_.size(),
         "rotations of turrets");
}

void Session::Driving::read(const v1::Observation& observation) {
  const double* number = observation.wheels().data();
  for (Wheels* wheels : wheels_) {
    wheels->reading_ = {number[0], number[1], number[2], number[3]};
    number += numbers_of_wheels;
  }
  number = observation.turret_rotations().data();
  for (Turret* turret : turrets_) turret->rotation_ = *number++;
}

void Session::Driving::write(v1::Command& command) const {
  const auto add = [](const Settings<double>& settings, auto& to) {
    if (settings.changed) to.Add(settings.values.begin(), settings.values.end());
  };
  add(velocities_, *command.mutable_wheel_velocities());
  add(rotations_, *command.mutable_turret_rotations());
  add(speeds_, *command.mutable_turret_speeds());
  if (!modes_.changed) return;
  for (const TurretMode mode : modes_.values) command.add_turret_modes(mode_of(mode));
}

void Session::Driving::sent() {
  velocities_.changed = false;
  modes_.changed = false;
  rotations_.changed = false;
  speeds_.changed = false;
}

void Session::Driving::repeat() {
  velocities_.changed = true;
  modes_.changed = true;
  rotations_.changed = true;
  speeds_.changed = true;
}

void Session::Driving::reset() {
  velocities_.reset();
  modes_.reset();
  rotations_.reset();
  speeds_.reset();
}

}  // namespace ziggurat
