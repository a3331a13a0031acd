// SPDX-License-Identifier: MIT
#include "devices/devices.h"

#include <algorithm>
#include <array>

#include "math/archive.h"

namespace ziggurat::devices {

// Each in its own file.
std::unique_ptr<Kind> make_joints();
std::unique_ptr<Kind> make_wheels();
std::unique_ptr<Kind> make_turrets();
std::unique_ptr<Kind> make_visible();
std::unique_ptr<Kind> make_radios();
std::unique_ptr<Kind> make_proximity();
std::unique_ptr<Kind> make_range_and_bearing();
std::unique_ptr<Kind> make_positioning();
std::unique_ptr<Kind> make_batteries();
std::unique_ptr<Kind> make_cameras();
std::unique_ptr<Kind> make_pictures();
std::unique_ptr<Kind> make_imus();
std::unique_ptr<Kind> make_contact_sensors();
std::unique_ptr<Kind> make_light();
std::unique_ptr<Kind> make_footbot_light();
std::unique_ptr<Kind> make_eyebot_light();
std::unique_ptr<Kind> make_ground();
std::unique_ptr<Kind> make_footbot_base_ground();
std::unique_ptr<Kind> make_footbot_motor_ground();
std::unique_ptr<Kind> make_distance_scanner();
std::unique_ptr<Kind> make_omnidirectional_camera();
std::unique_ptr<Kind> make_perspective_camera();
std::unique_ptr<Kind> make_gripper();
std::unique_ptr<Kind> make_epuck_proximity();
std::unique_ptr<Kind> make_epuck_light();
std::unique_ptr<Kind> make_epuck_ground();
std::unique_ptr<Kind> make_quadrotor();
std::unique_ptr<Kind> make_kilobot_motors();
std::unique_ptr<Kind> make_kilobot_communication();
std::unique_ptr<Kind> make_differential_drive();
std::unique_ptr<Kind> make_rangefinders();
std::unique_ptr<Kind> make_lift_system();
std::unique_ptr<Kind> make_ultrasound();

Devices::Devices() {
  constexpr std::array kinds{make_joints,
                             make_wheels,
                             make_turrets,
                             make_visible,
                             make_radios,
                             make_proximity,
                             make_range_and_bearing,
                             make_positioning,
                             make_batteries,
                             make_cameras,
                             make_pictures,
                             make_imus,
                             make_contact_sensors,
                             make_light,
                             make_footbot_light,
                             make_eyebot_light,
                             make_ground,
                             make_footbot_base_ground,
                             make_footbot_motor_ground,
                             make_distance_scanner,
                             make_omnidirectional_camera,
                             make_perspective_camera,
                             make_gripper,
                             make_epuck_proximity,
                             make_epuck_light,
                             make_epuck_ground,
                             make_quadrotor,
                             make_kilobot_motors,
                             make_kilobot_communication,
                             make_differential_drive,
                             make_rangefinders,
                             make_lift_system,
                             make_ultrasound};
  for (const auto make : kinds) kinds_.push_back(make());
  list_substep_kinds();
}

Devices::Devices(const Devices& other) {
  for (const auto& kind : other.kinds_) kinds_.push_back(kind->clone());
  list_substep_kinds();
}

void Devices::list_substep_kinds() {
  for (const auto& kind : kinds_) {
    if (kind->follows_substeps()) substep_kinds_.push_back(kind.get());
  }
}

void Devices::lay_out(const Carrier& carrier, world::RobotLayout& robot,
                      world::Layout& layout) const {
  for (const auto& kind : kinds_) kind->lay_out(carrier, robot, layout);
}

void Devices::add(const Setting& setting) {
  for (const auto& kind : kinds_) kind->add(setting);
}

void Devices::start(Tick& tick) {
  for (const auto& kind : kinds_) kind->start(tick);
}

void Devices::apply(Tick& tick) {
  for (const auto& kind : kinds_) kind->apply(tick);
}

void Devices::after_substep(Tick& tick) {
  for (Kind* const kind : substep_kinds_) kind->after_substep(tick);
}

void Devices::sense(Tick& tick) {
  for (const auto& kind : kinds_) kind->sense(tick);
}

void Devices::archive(math::Archive& archive) {
  for (const auto& kind : kinds_) kind->archive(archive);
}

bool Devices::casts_rays() const {
  return std::ranges::any_of(kinds_, [](const auto& kind) { return kind->casts_rays(); });
}

bool Devices::needs_index() const {
  return std::ranges::any_of(kinds_, [](const auto& kind) { return kind->needs_index(); });
}

}  // namespace ziggurat::devices
