// SPDX-License-Identifier: MIT
// The pi-puck: an e-puck that carries a Raspberry Pi (Millard et al., "The Pi-puck extension
// board", IROS 2017). Diameter and axle are the e-puck's, and so are the bearings of its infrared
// sensors, which serve as rangefinders, its ground sensors and its LEDs. No source states height
// and mass with the board, and the range: those are ours.

#include <cmath>
#include <variant>

#include "scene/robots/robots.h"

namespace ziggurat::scene::pi_puck {
namespace {

constexpr double board_height = 0.03;  // on top of the e-puck [m]
constexpr double board_mass = 0.05;    // [kg]
constexpr double range = 0.1;          // [m]

}  // namespace

void equip(Entity& entity) {
  e_puck::equip(entity);
  Link& body = entity.links.front();
  std::get<Cylinder>(body.geometry).height += board_height;
  body.mass += board_mass;
  for (const ProximitySensor& sensor : entity.devices.proximity_sensors) {
    const double bearing = std::atan2(sensor.direction.y(), sensor.direction.x());
    add_outward_place(entity, "rangefinders", bearing, sensor.offset.z(),
                      sensor.offset.head<2>().norm());
    entity.devices.places.back().settings = {range};
  }
  add_place(entity, "differential_drive", math::Vector3::Zero(), {*entity.axle_length});
}

}  // namespace ziggurat::scene::pi_puck
