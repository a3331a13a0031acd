// SPDX-License-Identifier: MIT
// Parts of robots on wheels.

#include <cmath>
#include <numbers>
#include <string>

#include "scene/robots/robots.h"

namespace ziggurat::scene {
namespace {

/// Surface of two-dimensional robots in the dialect. Their underside has no friction: their wheels
/// roll.
constexpr Surface body_surface{0.7, 0.0};

}  // namespace

Link wheeled_body(double radius, double height, double mass) {
  Link link;
  link.id = "base";
  link.geometry = Cylinder{radius, height};
  link.mass = mass;
  link.surface = body_surface;
  return link;
}

Link frame(std::string id, const math::Pose& offset) {
  Link link;
  link.id = std::move(id);
  link.geometry = Sphere{0};
  link.collides = false;
  link.offset = offset;
  return link;
}

ProximitySensor outward_sensor(double bearing, double height, double radius, double range) {
  const math::Vector3 outward(std::cos(bearing), std::sin(bearing), 0);
  ProximitySensor sensor;
  sensor.offset = radius * outward + math::Vector3(0, 0, height);
  sensor.direction = outward;
  sensor.range = range;
  return sensor;
}

void add_outward_place(Entity& entity, std::string_view name, double bearing, double height,
                       double radius) {
  const math::Quaternion turned(Eigen::AngleAxisd(bearing, math::Vector3::UnitZ()));
  const math::Vector3 offset(radius * std::cos(bearing), radius * std::sin(bearing), height);
  entity.devices.places.push_back({name, {}, {offset, turned}, {}});
}

DevicePlace& add_place(Entity& entity, std::string_view name, const math::Vector3& position,
                       std::vector<double> settings) {
  return entity.devices.places.emplace_back(
      DevicePlace{name, {}, {position, math::Quaternion::Identity()}, std::move(settings)});
}

void add_led_ring(Entity& entity, unsigned count, double first, double radius, double height) {
  auto& leds = entity.devices.leds;
  for (unsigned i = 0; i < count; ++i) {
    const double bearing = first + 2 * std::numbers::pi * i / count;
    const math::Vector3 offset(radius * std::cos(bearing), radius * std::sin(bearing), height);
    leds.push_back({"led_" + std::to_string(leds.size() + 1), {}, offset, Color{}, {}});
  }
}

RangeAndBearing level_range_and_bearing(double height, double range, unsigned data_size) {
  const math::Pose antenna{math::Vector3(0, 0, height), math::Quaternion::Identity()};
  return {{}, antenna, range, data_size, {}};
}

}  // namespace ziggurat::scene
