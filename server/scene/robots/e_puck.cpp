// SPDX-License-Identifier: MIT
// The e-puck. Diameter, axle and wheels: e-puck.org, "Mechanics of the e-puck" (EPFL): 70 mm,
// 53 mm, and 41 mm wheels that turn once a second at most. Height, mass, and reach and bearings of
// the infrared sensors: Webots User Guide, "Using the e-puck robot", tables 8.1 and 8.4: 45 mm,
// 150 g, 4 cm. Range and bearing: the board of Gutierrez et al. (ICRA 2009), two bytes to 0.8 m.
// No source states heights of sensors and LEDs, nor forces: those are ours.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene::e_puck {
namespace {

constexpr double body_radius = 0.035;  // [m]
constexpr double body_height = 0.045;  // [m]
constexpr double body_mass = 0.15;     // [kg]
constexpr double axle_length = 0.053;  // [m]
/// A tenth of the foot-bot's, as its mass is.
constexpr Traction traction{1.5, 15};  // [N], [N m]

/// PS0 ... PS7, clockwise from the right of the front, seen from above [rad].
constexpr std::array<double, 8> proximity_bearings{5.98, 5.48, 4.71, 3.64, 2.64, 1.57, 0.80, 0.30};
constexpr double proximity_height = 0.03;  // [m]
constexpr double proximity_range = 0.04;   // [m]

/// The same sensors as the dialect's own devices of the e-puck count them: counter-clockwise from
/// the left of the front [degrees].
constexpr std::array<double, 8> infrared_bearings{17, 50, 90, 150, -150, -90, -50, -17};

/// Counter-clockwise from 22.5 degrees, as the dialect has them.
constexpr unsigned light_sensors = 8;
constexpr double light_height = 0.03;  // [m]

/// Grey, from right to left [m].
constexpr double ground_front = 0.03;
constexpr std::array<double, 3> ground_offsets{-0.009, 0, 0.009};

/// LED0 in front, the others clockwise; then that of the body, on top, and the one beside the
/// camera.
constexpr unsigned leds = 8;
constexpr double led_radius = 0.0355;  // just outside of the body [m]
constexpr double led_height = 0.03;    // [m]

constexpr double body_led_height = 0.0455;                       // just above the body [m]
constexpr double front_led_y = -0.01, front_led_height = 0.035;  // [m]

constexpr double range_and_bearing_height = 0.045;  // [m]
constexpr double range_and_bearing_range = 0.8;     // [m]
constexpr unsigned range_and_bearing_bytes = 2;

}  // namespace

void equip(Entity& entity) {
  entity.links.push_back(wheeled_body(body_radius, body_height, body_mass));
  entity.traction = traction;
  entity.axle_length = axle_length;
  for (unsigned i = 0; i < leds; ++i) {
    const double bearing = -2 * std::numbers::pi * i / leds;
    const math::Vector3 offset(led_radius * std::cos(bearing), led_radius * std::sin(bearing),
                               led_height);
    entity.devices.leds.push_back({"led_" + std::to_string(i + 1), {}, offset, Color{}, {}});
  }
  const double front_led_x = std::sqrt(led_radius * led_radius - front_led_y * front_led_y);
  for (const math::Vector3& offset : {math::Vector3(0, 0, body_led_height),
                                      math::Vector3(front_led_x, front_led_y, front_led_height)}) {
    const std::string number = std::to_string(entity.devices.leds.size() + 1);
    entity.devices.leds.push_back({"led_" + number, {}, offset, Color{}, {}});
  }
  for (const double bearing : proximity_bearings) {
    entity.devices.proximity_sensors.push_back(
        outward_sensor(bearing, proximity_height, body_radius, proximity_range));
  }
  for (const double bearing : infrared_bearings) {
    add_outward_place(entity, "infrared", bearing * std::numbers::pi / 180, proximity_height,
                      body_radius);
  }
  for (const double y : ground_offsets) add_place(entity, "ground", {ground_front, y, 0});
  for (unsigned i = 0; i < light_sensors; ++i) {
    const double bearing = 2 * std::numbers::pi * (i + 0.5) / light_sensors;
    add_outward_place(entity, "light", bearing, light_height, body_radius);
  }
  entity.devices.range_and_bearing = level_range_and_bearing(
      range_and_bearing_height, range_and_bearing_range, range_and_bearing_bytes);
}

}  // namespace ziggurat::scene::e_puck
