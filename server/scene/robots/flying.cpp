// SPDX-License-Identifier: MIT
// Robots that fly. The eye-bot's ring of sensors, the counts of its devices and the cameras' ranges
// are the dialect's. No source states masses, sizes of bodies and limits of flight: those are ours.

#include <numbers>

#include "scene/robots/robots.h"

namespace ziggurat::scene::flying {
namespace {

struct Body {
  double radius, height, mass;  // [m], [kg]
};
constexpr Body eye_bot{0.25, 0.25, 1.5}, spiri{0.2, 0.1, 1}, mini_quadrotor{0.1, 0.05, 0.1};

/// An outer loop of 1/s asks for 3 m/s^2 at most, one of 2/s for 6.3 rad/s^2: less than they have,
/// so that they do not overshoot.
constexpr Flight flight{.max_speed = 3,
                        .max_acceleration = 4,
                        .max_turn_rate = std::numbers::pi,
                        .max_turn_acceleration = 10};

constexpr double ring_radius = 0.255;   // of the eye-bot's sensors and LEDs [m]
constexpr double ring_height = 0.1635;  // [m]
constexpr unsigned ring_sensors = 24;   // from 7.5 degrees on, evenly
constexpr double proximity_range = 3;   // [m]
constexpr unsigned ring_leds = 16;      // in an upper and a lower ring
constexpr double ring_gap = 0.05;       // from the sensors to each ring of LEDs [m]

constexpr double range_and_bearing_range = 3;  // [m]
constexpr unsigned range_and_bearing_bytes = 10;

void equip(Entity& entity, const Body& body) {
  entity.links.push_back(wheeled_body(body.radius, body.height, body.mass));
  entity.links.back().surface = Surface{};
  entity.flight = flight;
  add_place(entity, "quadrotor", math::Vector3::Zero());
}

/// @param pitch  of its x axis below the horizon [rad]
void add_camera_anchor(Entity& entity, std::string id, const math::Vector3& position,
                       double pitch) {
  const math::Quaternion turned(Eigen::AngleAxisd(pitch, math::Vector3::UnitY()));
  entity.links.push_back(frame(std::move(id), {position, turned}));
}

}  // namespace

void equip_eye_bot(Entity& entity) {
  equip(entity, eye_bot);
  add_camera_anchor(entity, "perspective_camera", math::Vector3::Zero(), std::numbers::pi / 2);
  for (unsigned i = 0; i < ring_sensors; ++i) {
    const double bearing = 2 * std::numbers::pi * (i + 0.5) / ring_sensors;
    entity.devices.proximity_sensors.push_back(
        outward_sensor(bearing, ring_height, ring_radius, proximity_range));
    add_outward_place(entity, "light", bearing, ring_height, ring_radius);
  }
  add_led_ring(entity, ring_leds, 0, ring_radius, ring_height + ring_gap);
  add_led_ring(entity, ring_leds, 0, ring_radius, ring_height - ring_gap);
  add_led_ring(entity, 1, 0, 0, 0);  // below
  entity.devices.range_and_bearing =
      level_range_and_bearing(ring_height, range_and_bearing_range, range_and_bearing_bytes);
}

void equip_spiri(Entity& entity) {
  equip(entity, spiri);
  add_camera_anchor(entity, "camera", {spiri.radius, 0, spiri.height / 2}, 0);
  entity.devices.range_and_bearing =
      level_range_and_bearing(spiri.height / 2, range_and_bearing_range, range_and_bearing_bytes);
}

void equip_mini_quadrotor(Entity& entity) { equip(entity, mini_quadrotor); }

void add_camera(Entity& entity, const Camera& camera) {
  DevicePlace& place = add_place(entity, "colored_blob_perspective_camera", math::Vector3::Zero(),
                                 {camera.aperture, camera.focal_length, camera.range});
  place.anchor.link = static_cast<int>(entity.links.size()) - 1;
}

}  // namespace ziggurat::scene::flying
