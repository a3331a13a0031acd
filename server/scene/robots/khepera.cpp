// SPDX-License-Identifier: MIT
// The Khepera IV. Sizes, mass and counts are those of K-Team's "Khepera IV User Manual". Infrared
// looks out each 45 degrees, counter-clockwise from ahead, as "Buzz on the Khepera IV" says.
// Bearings of ultrasound, heights, places below and of LEDs, and forces are ours.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene::khepera {
namespace {

constexpr double body_radius = 0.0704;  // [m]
constexpr double body_height = 0.058;   // [m]
constexpr double body_mass = 0.54;      // [kg]
constexpr double axle_length = 0.1054;  // [m]
/// In proportion to the e-puck's, as its mass is.
constexpr Traction traction{5.4, 54};  // [N], [N m]

/// Counter-clockwise from the front.
constexpr unsigned infrared_sensors = 8;
constexpr double infrared_height = 0.03, infrared_range = 0.25;  // [m]

/// Ours, from left to right [degrees].
constexpr std::array<double, 5> ultrasound_bearings{90, 45, 0, -45, -90};
constexpr double ultrasound_height = 0.04, nearest = 0.2, farthest = 2;  // [m]

/// From left to right [m].
constexpr std::array<std::array<double, 2>, 4> ground_offsets{
    {{0.03, 0.05}, {0.055, 0.015}, {0.055, -0.015}, {0.03, -0.05}}};

/// On top: left, right, behind.
constexpr unsigned leds = 3;
constexpr double led_radius = 0.05, led_height = 0.0585;  // [m]

constexpr double range_and_bearing_range = 3;  // [m]
constexpr unsigned range_and_bearing_bytes = 10;

}  // namespace

void equip(Entity& entity) {
  entity.links.push_back(wheeled_body(body_radius, body_height, body_mass));
  entity.traction = traction;
  entity.axle_length = axle_length;
  for (unsigned i = 0; i < infrared_sensors; ++i) {
    const double bearing = 2 * std::numbers::pi * i / infrared_sensors;
    entity.devices.proximity_sensors.push_back(
        outward_sensor(bearing, infrared_height, body_radius, infrared_range));
    add_outward_place(entity, "light", bearing, infrared_height, body_radius);
  }
  for (const double bearing : ultrasound_bearings) {
    add_outward_place(entity, "ultrasound", bearing * std::numbers::pi / 180, ultrasound_height,
                      body_radius);
    entity.devices.places.back().settings = {farthest, nearest};
  }
  for (const auto& [x, y] : ground_offsets) add_place(entity, "ground", {x, y, 0});
  add_led_ring(entity, leds, std::numbers::pi / 3, led_radius, led_height);
  entity.devices.range_and_bearing =
      level_range_and_bearing(body_height, range_and_bearing_range, range_and_bearing_bytes);
}

}  // namespace ziggurat::scene::khepera
