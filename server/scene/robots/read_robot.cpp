// SPDX-License-Identifier: MIT
// <foot-bot>, <e-puck>, …: what a scene may say of a robot that comes as it is.

#include <algorithm>
#include <array>
#include <numbers>

#include "scene/draft.h"
#include "scene/robots/robots.h"

namespace ziggurat::scene {
namespace {

void read_steering_limits(Element engine, Traction& traction) {
  if (auto steering = engine.child("differential_steering")) {
    traction.max_force = steering->optional("max_force", In{"N", positive}, traction.max_force);
    traction.max_torque =
        steering->optional("max_torque", In{"N·m", positive}, traction.max_torque);
    steering->done();
  }
  engine.done();
}

/// Half-angle of a camera, below 90 degrees.
double read_aperture(Element& element, const char* name, double usual) {
  const double found = element.optional(name, half_angle, usual);
  if (found < std::numbers::pi / 2 && found > 0) return found;
  element.fault_at(name, "must be more than 0 and less than 90 degrees");
  return usual;
}

constexpr double usual_aperture = std::numbers::pi / 6;  // of perspective cameras [rad]

void read_blob_cameras(Element& element, Entity& entity) {
  foot_bot::BlobCameras cameras{};
  cameras.omnidirectional_aperture =
      read_aperture(element, "omnidirectional_camera_aperture", 7 * std::numbers::pi / 18);
  cameras.looks_ahead = element.optional("perspective_camera_front", boolean, true);
  cameras.aperture = read_aperture(element, "perspective_camera_aperture", usual_aperture);
  cameras.focal_length =
      element.optional("perspective_camera_focal_length", In{"m", positive}, 0.035);
  cameras.range = element.optional("perspective_camera_range", In{"m", positive}, 2.0);
  foot_bot::add_blob_cameras(entity, cameras);
}

void read_wifi(Element& element, Entity& entity) {
  constexpr double usual_range = 10;  // [m]
  foot_bot::add_wifi(entity, element.optional("wifi_range", In{"m", positive}, usual_range));
}

void read_foot_bot(Element& element, Entity& entity) {
  read_blob_cameras(element, entity);
  read_wifi(element, entity);
}

/// The e-puck has no such camera.
void ignore_blob_cameras(Element& element, Entity&) {
  element.optional("perspective_camera_aperture", half_angle);
  element.optional("perspective_camera_focal_length", In{"m", positive});
  element.optional("perspective_camera_range", In{"m", positive});
}

void read_pi_puck(Element& element, Entity& entity) {
  ignore_blob_cameras(element, entity);
  read_wifi(element, entity);
}

void read_flying_camera(Element& element, Entity& entity, double usual_range) {
  flying::add_camera(entity, {read_aperture(element, "camera_aperture", usual_aperture),
                              element.optional("camera_focal_length", In{"m", positive}, 0.035),
                              element.optional("camera_range", In{"m", positive}, usual_range)});
}

void read_eye_bot_camera(Element& element, Entity& entity) {
  element.without_effect("camera_front", boolean, "the camera looks down");
  read_flying_camera(element, entity, 2);
}

void read_spiri_camera(Element& element, Entity& entity) {
  read_flying_camera(element, entity, 10);
}

void read_kilobot(Element& element, Entity& entity) {
  constexpr double usual_range = 0.1;  // [m]
  kilobot::add_devices(entity,
                       {element.optional("left_motor", positive, 1.0),
                        element.optional("right_motor", positive, 1.0),
                        element.optional("communication_range", In{"m", positive}, usual_range)});
  // There is one medium of messages, unless the sensor names another one.
  element.without_effect("communication_medium", identifier, "the sensor's medium counts");
}

void read_nothing(Element&, Entity&) {}

struct Robot {
  EntityKind kind;
  void (*equip)(Entity& entity);
  void (*read)(Element& element, Entity& entity);  ///< what only this robot's element may have
};

constexpr auto robots = std::to_array<Robot>({
    {EntityKind::foot_bot, foot_bot::equip, read_foot_bot},
    {EntityKind::e_puck, e_puck::equip, ignore_blob_cameras},
    {EntityKind::eye_bot, flying::equip_eye_bot, read_eye_bot_camera},
    {EntityKind::spiri, flying::equip_spiri, read_spiri_camera},
    {EntityKind::kilobot, kilobot::equip, read_kilobot},
    {EntityKind::pi_puck, pi_puck::equip, read_pi_puck},
    {EntityKind::builderbot, builderbot::equip, read_wifi},
    {EntityKind::khepera, khepera::equip, read_nothing},
    {EntityKind::mini_quadrotor, flying::equip_mini_quadrotor, read_nothing},
});

/// Puts devices on the first medium of their type. Where there is none nothing perceives them, and
/// they are left out.
void assign_media(Draft& draft, Element& element, Devices& devices) {
  for (const char* name : {"led_medium", "nfc_medium", "tag_medium", "wifi_medium"}) {
    element.without_effect(name, identifier, "the first medium of the type counts");
  }
  devices.led_medium = first_medium(draft.scene, MediumKind::led);
  devices.radio_medium = first_medium(draft.scene, MediumKind::radio);
  devices.tag_medium = first_medium(draft.scene, MediumKind::tag);
  devices.directional_led_medium = first_medium(draft.scene, MediumKind::directional_led);
  if (!devices.radio_medium) devices.radios.clear();
  if (!devices.tag_medium) devices.tags.clear();
  if (!devices.directional_led_medium) devices.directional_leds.clear();
}

/// Range and bearing, of a robot that has it.
void read_antenna(Draft& draft, Element& element, Devices& devices) {
  if (!devices.range_and_bearing) return;
  RangeAndBearing& antenna = *devices.range_and_bearing;
  antenna.range = element.optional("rab_range", In{"m", positive}, antenna.range);
  antenna.data_size =
      element.optional("rab_data_size", Whole{0, most_data_bytes}, antenna.data_size);
  devices.range_and_bearing_medium = first_medium(draft.scene, MediumKind::range_and_bearing);
}

}  // namespace

std::optional<std::size_t> first_medium(const Scene& scene, MediumKind kind) {
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    if (scene.media[i].kind == kind) return i;
  }
  return std::nullopt;
}

void read_block(Draft& draft, Element& element, Entity& entity) {
  block::equip(entity);
  entity.movable = element.optional("movable", boolean, true);
  const Color at_first = element.optional("init_led_color", color, Color{});
  for (DirectionalLed& led : entity.devices.directional_leds) led.color = at_first;
  for (Led& led : entity.devices.leds) led.color = at_first;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    entity.links[i].where = element.where();
    draft.anchors.emplace(entity.links[i].id, i);
  }
  assign_media(draft, element, entity.devices);
}

bool is_robot(EntityKind kind) {
  return std::ranges::find(robots, kind, &Robot::kind) != robots.end();
}

void read_robot(Draft& draft, Element& element, Entity& entity) {
  const Robot& robot = *std::ranges::find(robots, entity.kind, &Robot::kind);
  robot.equip(entity);
  entity.movable = element.optional("movable", boolean, true);
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    entity.links[i].where = element.where();
    draft.anchors.emplace(entity.links[i].id, i);
  }
  Devices& devices = entity.devices;
  assign_media(draft, element, devices);
  read_antenna(draft, element, devices);
  robot.read(element, entity);
  devices.battery = Battery{};  // which nothing discharges
  if (auto battery = element.child("battery")) devices.battery = read_battery(*battery);
  if (!entity.traction) return;
  if (auto engine = element.child("dynamics2d")) read_steering_limits(*engine, *entity.traction);
}

}  // namespace ziggurat::scene
