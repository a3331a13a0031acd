// SPDX-License-Identifier: MIT
// The stigmergic block of scenes/models/block.argos, where its sources are: a cube with a freely
// turning magnet near each corner, and on each face four LEDs, a tag and a radio.

#include <array>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene::block {
namespace {

constexpr double side = 0.055, mass = 0.102;                  // [m], [kg]
constexpr double sphere_radius = 0.003, sphere_mass = 0.001;  // [m], [kg]
constexpr double field = 65;                                  // of a magnet
constexpr double from_middle = 0.0225;                        // magnets [m]
constexpr double outside = side / 2 + 0.0005;                 // devices, from the middle [m]
constexpr double led_offset = 0.02, radio_range = 0.03;       // [m]
constexpr double tag_side = 0.024;                            // [m]
constexpr double degree = std::numbers::pi / 180;
constexpr double tag_angle = 75 * degree, led_angle = 80 * degree;
constexpr int base = 0;

/// A face: its normal's axis and sign, and the turn that takes z to it, about x or y.
struct Face {
  int axis;
  double sign, about_x, about_y;  // [degrees]
};
constexpr std::array<Face, 6> faces{{{0, 1, 0, 90},
                                     {1, 1, -90, 0},
                                     {0, -1, 0, -90},
                                     {1, -1, 90, 0},
                                     {2, 1, 0, 0},
                                     {2, -1, 180, 0}}};

template <class List>
std::string next_id(std::string_view stem, const List& devices) {
  return std::string(stem) + "_" + std::to_string(devices.size());
}

void add_magnet(Entity& entity, const math::Vector3& place) {
  const std::size_t number = entity.links.size();
  Link& sphere = entity.links.emplace_back();
  sphere.id = "sphere" + std::to_string(number);
  sphere.geometry = Sphere{sphere_radius};
  sphere.mass = sphere_mass;
  const math::Vector3 middle(0, 0, sphere_radius);
  sphere.offset.position = place - middle;
  Joint& socket = entity.joints.emplace_back();
  socket.id = "socket" + std::to_string(number);
  socket.type = JointType::spherical;
  socket.child = number;
  socket.parent_frame.position = place;
  socket.child_frame.position = middle;
  Magnet& magnet = entity.devices.magnets.emplace_back();
  magnet.id = "magnet_" + std::to_string(number - 1);
  magnet.anchor = {static_cast<int>(number)};
  magnet.offset = middle;
  magnet.passive_field = {0, 0, field};
}

void add_face(Entity& entity, const Face& face) {
  Devices& devices = entity.devices;
  const math::Quaternion orientation =
      math::Quaternion(Eigen::AngleAxisd(face.about_x * degree, math::Vector3::UnitX())) *
      math::Quaternion(Eigen::AngleAxisd(face.about_y * degree, math::Vector3::UnitY()));
  math::Vector3 middle(0, 0, side / 2);
  middle[face.axis] += face.sign * outside;
  devices.radios.push_back({next_id("radio", devices.radios), {base}, middle, radio_range, {}});
  devices.tags.push_back({next_id("tag", devices.tags),
                          {base},
                          {middle, orientation},
                          tag_angle,
                          tag_side,
                          std::to_string(devices.tags.size()),
                          {}});
  const int first = face.axis == 0 ? 1 : 0, second = face.axis == 2 ? 1 : 2;
  for (const double a : {-led_offset, led_offset}) {
    for (const double b : {-led_offset, led_offset}) {
      math::Vector3 place = middle;
      place[first] += a;
      place[second] += b;
      devices.directional_leds.push_back({next_id("directional_led", devices.directional_leds),
                                          {base},
                                          {place, orientation},
                                          led_angle,
                                          Color{},
                                          {}});
    }
  }
}

}  // namespace

void equip(Entity& entity) {
  Link& cube = entity.links.emplace_back();
  cube.id = "base";
  cube.geometry = Box{{side, side, side}};
  cube.mass = mass;
  for (const double z : {side / 2 - from_middle, side / 2 + from_middle}) {
    for (const double x : {-from_middle, from_middle}) {
      for (const double y : {-from_middle, from_middle}) add_magnet(entity, {x, y, z});
    }
  }
  for (const Face& face : faces) add_face(entity, face);
}

}  // namespace ziggurat::scene::block
