// SPDX-License-Identifier: MIT
// The builderbot: a body on wheels whose lift moves an end effector with four electromagnets.
// Places of sensors and magnets, and the heights of the lift, are those of our construction robot,
// scenes/models/robot.argos, whose sources are there. Here the body is one box that drives like a
// two-wheeled robot.

#include <array>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene::builderbot {
namespace {

constexpr std::array<double, 3> body{0.13, 0.116, 0.06};            // [m]
constexpr double body_mass = 1.3;                                   // [kg]
constexpr std::array<double, 3> end_effector{0.055, 0.055, 0.012};  // [m]
constexpr double end_effector_mass = 0.22;                          // with arm and carriage [kg]
constexpr std::array<double, 3> lowest{0.1075, 0, 0.0555};          // of it, above a block [m]
constexpr double lift_height = 0.14;                                // [m]
constexpr double lift_force = 40;                                   // [N]
constexpr double axle_length = 0.104;                               // [m]
constexpr Traction traction{15, 1.5};                               // [N], [N m]
constexpr int lifted = 1;                                           // the link

/// Rangefinders: places, and directions about +z. The first twelve are on the body,
/// counter-clockwise from the middle of the front.
struct Rangefinder {
  double x, y, bearing;  // [m], [quarter turns]
};
constexpr std::array<Rangefinder, 12> around{{{0.065, 0, 0},
                                              {0.065, 0.022, 0},
                                              {0.045, 0.058, 1},
                                              {0, 0.058, 1},
                                              {-0.045, 0.058, 1},
                                              {-0.065, 0.03, 2},
                                              {-0.065, 0, 2},
                                              {-0.065, -0.03, 2},
                                              {-0.045, -0.058, 3},
                                              {0, -0.058, 3},
                                              {0.045, -0.058, 3},
                                              {0.065, -0.022, 0}}};
constexpr double around_height = 0.03, range = 0.2;  // [m]
constexpr double quarter = std::numbers::pi / 2;

constexpr double magnet_offset = 0.0225, magnet_height = 0.005;  // [m]
constexpr double field = 100;                                    // passive, and per current
constexpr unsigned ring_leds = 12;

math::Quaternion turned(double angle, const math::Vector3& axis) {
  return math::Quaternion(Eigen::AngleAxisd(angle, axis));
}

math::Vector3 vector(const std::array<double, 3>& from) { return {from[0], from[1], from[2]}; }

void add_rangefinder(Entity& entity, Anchor anchor, const math::Vector3& position,
                     const math::Quaternion& orientation) {
  DevicePlace& place = add_place(entity, "rangefinders", position, {range});
  place.anchor = anchor;
  place.pose.orientation = orientation;
}

void add_rangefinders(Entity& entity) {
  for (const Rangefinder& each : around) {
    add_rangefinder(entity, {}, {each.x, each.y, around_height},
                    turned(each.bearing * quarter, math::Vector3::UnitZ()));
  }
  const math::Quaternion down = turned(quarter, math::Vector3::UnitY());
  add_rangefinder(entity, {lifted}, {0, 0, 0}, down);
  add_rangefinder(entity, {lifted}, {end_effector[0] / 2, 0, 0.006}, math::Quaternion::Identity());
  add_rangefinder(entity, {lifted}, {0, 0.0235, 0}, down);
  add_rangefinder(entity, {lifted}, {0, -0.0235, 0}, down);
}

void add_magnets(Entity& entity) {
  for (const double x : {-magnet_offset, magnet_offset}) {
    for (const double y : {-magnet_offset, magnet_offset}) {
      Magnet magnet;
      magnet.id = "magnet_" + std::to_string(entity.devices.magnets.size());
      magnet.anchor = {lifted};
      magnet.offset = {x, y, magnet_height};
      magnet.passive_field = magnet.active_field = {0, 0, field};
      entity.devices.magnets.push_back(magnet);
    }
  }
}

}  // namespace

void equip(Entity& entity) {
  Link base = wheeled_body(1, 1, body_mass);
  base.geometry = Box{vector(body)};
  entity.links.push_back(base);
  Link& effector = entity.links.emplace_back();
  effector.id = "end_effector";
  effector.geometry = Box{vector(end_effector)};
  effector.mass = end_effector_mass;
  Joint& lift = entity.joints.emplace_back();
  lift.id = "lift";
  lift.type = JointType::prismatic;
  lift.limit = JointLimit{0, lift_height};
  lift.child = lifted;
  lift.parent_frame.position = vector(lowest);
  entity.traction = traction;
  entity.axle_length = axle_length;
  add_place(entity, "differential_drive", math::Vector3::Zero(), {axle_length});
  add_place(entity, "lift_system", math::Vector3::Zero(), {0, lift_force});
  add_rangefinders(entity);
  add_magnets(entity);
  add_led_ring(entity, ring_leds, 0, body[1] / 2, body[2] + 0.001);
  entity.devices.radios.push_back({"nfc", {lifted}, math::Vector3::Zero(), 0.03, {}});
}

Camera camera() {
  Camera camera;
  camera.id = "camera";
  camera.anchor = "base";
  camera.pose = {math::Vector3(0.0055, 0, 0.0275), turned(quarter, math::Vector3::UnitY()) *
                                                       turned(-quarter, math::Vector3::UnitZ())};
  camera.near = 0.05;
  camera.far = 1;
  camera.focal_length = {884, 884};
  camera.principal_point = {320, 180};
  camera.resolution = {640, 360};
  return camera;
}

}  // namespace ziggurat::scene::builderbot
