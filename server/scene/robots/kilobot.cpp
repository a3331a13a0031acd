// SPDX-License-Identifier: MIT
// The kilobot. Rubenstein, Ahler and Nagpal, "Kilobot: A low cost scalable robot system for
// collective behaviors" (ICRA 2012): 33 mm in diameter, 34 mm high, 1 cm/s ahead, 45 degrees/s on
// the spot. Rubenstein, Cornejo and Nagpal, "Programmable self-assembly in a thousand-robot swarm"
// (Science 345, 2014): messages reach three diameters, some 10 cm. No source states mass, forces
// and the places of legs and sensors: those are ours.

#include "scene/robots/robots.h"

namespace ziggurat::scene::kilobot {
namespace {

constexpr double radius = 0.0165;        // [m]
constexpr double height = 0.034;         // [m]
constexpr double mass = 0.02;            // [kg]
constexpr double axle_length = 0.025;    // between the rear legs [m]
constexpr Traction traction{0.2, 0.01};  // [N], [N m]
constexpr double board_height = 0.015;   // of the LED and the infrared sensors [m]

}  // namespace

void equip(Entity& entity) {
  entity.links.push_back(wheeled_body(radius, height, mass));
  entity.traction = traction;
  entity.axle_length = axle_length;
  entity.devices.leds.push_back({"led_1", {}, {radius, 0, board_height}, Color{}, {}});
  add_place(entity, "light", {0, 0, height});
}

void add_devices(Entity& entity, const Settings& settings) {
  add_place(entity, "kilobot_motors", math::Vector3::Zero(),
            {settings.left_motor, settings.right_motor, axle_length});
  add_place(entity, "kilobot_communication", {0, 0, board_height}, {settings.range});
}

}  // namespace ziggurat::scene::kilobot
