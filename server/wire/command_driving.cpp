#include "wire/command_driving.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wire/command_packing.h"

namespace ziggurat::wire {
namespace {

constexpr std::size_t wheels_per_robot = 2;

bool is_finite(double value) { return std::isfinite(value); }
bool is_mode(int mode) { return mode > v1::TURRET_MODE_UNSPECIFIED && mode <= v1::TURRET_SPEED; }

std::optional<Fault> check_counts(const v1::Command& command, const Roster& roster) {
  const auto check = [&](const Packing& packing, int count, const Field& field,
                         std::size_t per_device = 1) {
    return check_count(command, packing, static_cast<std::size_t>(count), field, per_device);
  };
  if (auto found = check(roster.wheel_actuators, command.wheel_velocities_size(),
                         {"wheel_velocities", "wheel speeds", "pairs of wheels with an actuator"},
                         wheels_per_robot)) {
    return found;
  }
  constexpr const char* turrets = "turrets with an actuator";
  if (auto found = check(roster.turret_actuators, command.turret_modes_size(),
                         {"turret_modes", "turret modes", turrets})) {
    return found;
  }
  if (auto found = check(roster.turret_actuators, command.turret_rotations_size(),
                         {"turret_rotations", "turret rotations", turrets})) {
    return found;
  }
  return check(roster.turret_actuators, command.turret_speeds_size(),
               {"turret_speeds", "turret speeds", turrets});
}

}  // namespace

std::optional<Fault> check_driving(const v1::Command& command, const Roster& roster,
                                   const world::Layout& layout) {
  if (auto found = check_counts(command, roster)) return found;
  // The first value that breaks the rule is named.
  const auto check = [&](const Packing& packing, const auto& values, std::size_t per_device,
                         const char* field, auto is_good, const char* what,
                         const char* right) -> std::optional<Fault> {
    const auto bad = std::find_if_not(values.begin(), values.end(), is_good);
    if (bad == values.end()) return std::nullopt;
    const auto index = static_cast<std::size_t>(bad - values.begin()) / per_device;
    const std::string& robot = owner(command, roster, layout, packing, index).first->id;
    return make_fault(
        ErrorCode::bad_value, field,
        fmt::format("The {} of robot '{}' is {}; it must be {}.", what, robot, *bad, right), robot);
  };
  if (auto found = check(roster.wheel_actuators, command.wheel_velocities(), wheels_per_robot,
                         "wheel_velocities", is_finite, "speed of a wheel", "finite")) {
    return found;
  }
  if (auto found =
          check(roster.turret_actuators, command.turret_modes(), 1, "turret_modes", is_mode,
                "turret mode", "TURRET_PASSIVE, TURRET_POSITION or TURRET_SPEED")) {
    return found;
  }
  if (auto found = check(roster.turret_actuators, command.turret_rotations(), 1, "turret_rotations",
                         is_finite, "turret rotation", "finite")) {
    return found;
  }
  return check(roster.turret_actuators, command.turret_speeds(), 1, "turret_speeds", is_finite,
               "turret speed", "finite");
}

void apply_driving(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  const auto for_each = [&](const Packing& packing, const auto& values, auto set) {
    if (values.empty()) return;
    for_each_device(command, roster, packing, [&](std::size_t index, std::size_t flat) {
      set(static_cast<int>(index), flat);
    });
  };
  for_each(roster.wheel_actuators, command.wheel_velocities(), [&](int i, std::size_t flat) {
    commands.wheels[flat] = {command.wheel_velocities(2 * i), command.wheel_velocities(2 * i + 1)};
  });
  for_each(roster.turret_actuators, command.turret_modes(), [&](int i, std::size_t flat) {
    // The wire counts from 1.
    const int mode = command.turret_modes(i) - v1::TURRET_PASSIVE;
    commands.turrets[flat].mode = static_cast<world::TurretMode>(mode);
  });
  for_each(roster.turret_actuators, command.turret_rotations(), [&](int i, std::size_t flat) {
    commands.turrets[flat].rotation = command.turret_rotations(i);
  });
  for_each(roster.turret_actuators, command.turret_speeds(), [&](int i, std::size_t flat) {
    commands.turrets[flat].speed = command.turret_speeds(i);
  });
}

}  // namespace ziggurat::wire
