// SPDX-License-Identifier: MIT
// The foot-bot of the dialect: its geometry, its anchors, and the devices that exist here.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene::foot_bot {
namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr double body_radius = 0.085036758;  // [m]
constexpr double body_height = 0.146899733;  // [m]
constexpr double body_mass = 1.6;            // [kg]
constexpr double axle_length = 0.14;         // [m]
constexpr Traction traction{15, 150};        // [N], [N m]

constexpr double perspective_camera_x = 0.085036758;  // [m]
constexpr double perspective_camera_z = 0.174249733;  // [m]

constexpr unsigned ring_leds = 12;               // from 15 degrees on, evenly
constexpr double led_ring_radius = 0.090036758;  // [m]
constexpr double led_ring_height = 0.085;        // [m]
constexpr double beacon_height = 0.174249733;    // [m]

constexpr unsigned proximity_sensors = 24;  // from 7.5 degrees on, evenly; with light sensors
constexpr double proximity_height = 0.06;   // [m]
constexpr double proximity_range = 0.1;     // [m]

/// Grey ones by the wheels, then those of the base that tell black from white, counter-clockwise
/// from the front [m].
constexpr std::array<std::array<double, 2>, 4> motor_ground{
    {{0.063, 0.0116}, {-0.063, 0.0116}, {-0.063, -0.0116}, {0.063, -0.0116}}};
constexpr std::array<std::array<double, 2>, 8> base_ground{{{0.08, 0},
                                                            {0.042, 0.065},
                                                            {0, 0.08},
                                                            {-0.042, 0.065},
                                                            {-0.08, 0},
                                                            {-0.042, -0.065},
                                                            {0, -0.08},
                                                            {0.042, -0.065}}};

constexpr double gripper_radius = 0.01;  // of an upright cylinder about the turret's front [m]

constexpr double scanner_height = 0.123199866;  // [m]; its rays begin at the body's surface
constexpr double omnidirectional_camera_height = 0.288699733;  // [m]

constexpr double range_and_bearing_height = 0.1;  // [m]
constexpr double range_and_bearing_range = 3;     // [m]
constexpr unsigned range_and_bearing_bytes = 10;

Led led(unsigned number, int anchor, const math::Vector3& offset) {
  return {"led_" + std::to_string(number), {anchor}, offset, Color{}, {}};
}

void add_leds(Entity& entity, int turret) {
  for (unsigned i = 0; i < ring_leds; ++i) {
    const double bearing = (15 + 360.0 / ring_leds * i) * degree;
    entity.devices.leds.push_back(led(i + 1, turret,
                                      {led_ring_radius * std::cos(bearing),
                                       led_ring_radius * std::sin(bearing), led_ring_height}));
  }
  entity.devices.leds.push_back(led(ring_leds + 1, turret, {0, 0, beacon_height}));
}

void add_ground_sensors(Entity& entity) {
  for (const auto& [x, y] : motor_ground) {
    for (const char* name : {"ground", "motor_ground"}) add_place(entity, name, {x, y, 0});
  }
  for (const auto& [x, y] : base_ground) {
    for (const char* name : {"ground", "base_ground"}) add_place(entity, name, {x, y, 0}, {1});
  }
}

}  // namespace

void add_blob_cameras(Entity& entity, const BlobCameras& cameras) {
  add_place(entity, "colored_blob_omnidirectional_camera", {0, 0, omnidirectional_camera_height},
            {cameras.omnidirectional_aperture});
  // Along the anchor's +x, or upward.
  const double pitch = cameras.looks_ahead ? 0 : -std::numbers::pi / 2;
  const math::Quaternion turned(Eigen::AngleAxisd(pitch, math::Vector3::UnitY()));
  DevicePlace& place = add_place(entity, "colored_blob_perspective_camera", math::Vector3::Zero(),
                                 {cameras.aperture, cameras.focal_length, cameras.range});
  place.anchor.link = static_cast<int>(entity.links.size()) - 1;
  place.pose.orientation = turned;
}

void equip(Entity& entity) {
  entity.links.push_back(wheeled_body(body_radius, body_height, body_mass));
  entity.turret = entity.links.size();
  entity.links.push_back(frame("turret", {}));
  entity.links.push_back(
      frame("perspective_camera", {math::Vector3(perspective_camera_x, 0, perspective_camera_z),
                                   math::Quaternion::Identity()}));
  entity.traction = traction;
  entity.axle_length = axle_length;
  add_ground_sensors(entity);
  add_place(entity, "footbot_distance_scanner", {0, 0, scanner_height}, {body_radius});
  add_place(entity, "gripper", {body_radius, 0, 0}, {gripper_radius, body_height}).anchor.link =
      static_cast<int>(*entity.turret);
  add_leds(entity, static_cast<int>(*entity.turret));
  for (unsigned i = 0; i < proximity_sensors; ++i) {
    const double bearing = (7.5 + 360.0 / proximity_sensors * i) * degree;
    entity.devices.proximity_sensors.push_back(
        outward_sensor(bearing, proximity_height, body_radius, proximity_range));
    add_outward_place(entity, "light", bearing, proximity_height, body_radius);
  }
  entity.devices.range_and_bearing = level_range_and_bearing(
      range_and_bearing_height, range_and_bearing_range, range_and_bearing_bytes);
}

void add_wifi(Entity& entity, double range) {
  entity.devices.radios.push_back({"wifi", {}, {0, 0, range_and_bearing_height}, range, {}});
}

}  // namespace ziggurat::scene::foot_bot
