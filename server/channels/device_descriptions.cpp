// SPDX-License-Identifier: MIT
// The devices of the message World.

#include <variant>

#include "channels/world_message.h"
#include "render/tag36h11.h"

namespace ziggurat::channels {
namespace {

void set_mount(const Population& from, const world::Mount& mount, v1::World::Mount& to) {
  const Mounted place = mounted(from, mount);
  to.set_link(index(place.link));
  add(place.pose.position, *to.mutable_position());
  add(place.pose.orientation, *to.mutable_orientation());
}

void describe_cameras(const Population& from, std::size_t robot, v1::World& to) {
  const world::Range& cameras = from.layout.robots[robot].cameras;
  for (std::size_t i = cameras.begin; i < cameras.end(); ++i) {
    const world::CameraLayout& camera = from.layout.cameras[i];
    v1::World::Camera& described = *to.add_cameras();
    described.set_id(v1::valid_utf8(camera.id));
    described.set_robot(index(robot));
    set_mount(from, camera.mount, *described.mutable_mount());
    described.set_near(camera.near);
    described.set_far(camera.far);
    for (const double value : camera.focal_length) described.add_focal_length(value);
    for (const double value : camera.principal_point) described.add_principal_point(value);
    described.set_width(camera.resolution[0]);
    described.set_height(camera.resolution[1]);
    described.set_detects_leds(camera.leds.has_value());
    described.set_detects_directional_leds(camera.directional_leds.has_value());
    described.set_detects_tags(camera.tags.has_value());
    described.set_image(camera.image);
  }
}

void describe_radios(const Population& from, std::size_t robot, v1::World& to) {
  const world::RobotLayout& layout = from.layout.robots[robot];
  for (std::size_t i = layout.radios.begin; i < layout.radios.end(); ++i) {
    const world::RadioLayout& radio = from.layout.radios[i];
    v1::World::Radio& described = *to.add_radios();
    described.set_id(v1::valid_utf8(radio.id));
    described.set_robot(index(robot));
    set_mount(from, radio.mount, *described.mutable_mount());
    described.set_range(radio.range);
    described.set_sends(radio.sends);
    described.set_receives(radio.receives);
  }
  for (std::size_t i = layout.proximity.begin; i < layout.proximity.end(); ++i) {
    const world::ProximityLayout& sensor = from.layout.proximity[i];
    v1::World::Proximity& described = *to.add_proximity_sensors();
    described.set_robot(index(robot));
    set_mount(from, sensor.mount, *described.mutable_mount());
    // The direction is given in the frame of the anchor, which for an origin is not the link's.
    const math::Quaternion anchor =
        mounted(from, {sensor.mount.entity, sensor.mount.link, {}}).pose.orientation;
    add(math::Vector3(anchor * sensor.direction), *described.mutable_direction());
    described.set_range(sensor.range);
  }
}

template <class Layout>
void describe_led(const Population& from, const Layout& led, v1::World::Led& to) {
  to.set_id(v1::valid_utf8(led.id));
  to.set_entity(index(led.mount.entity));
  set_mount(from, led.mount, *to.mutable_mount());
}

void describe_tags(const Population& from, v1::World& to) {
  for (std::size_t i = 0; i < from.layout.tags.size(); ++i) {
    const world::TagLayout& tag = from.layout.tags[i];
    v1::World::Tag& described = *to.add_tags();
    described.set_id(v1::valid_utf8(tag.id));
    described.set_entity(index(tag.mount.entity));
    set_mount(from, tag.mount, *described.mutable_mount());
    described.set_side_length(tag.side_length);
    described.set_observable_angle(tag.observable_angle);
    described.set_payload(from.state.tag_payloads[i]);
  }
  if (from.layout.tags.empty()) return;
  for (const std::uint64_t pattern : render::tag36h11_patterns()) to.add_tag_patterns(pattern);
}

void set_shape(const scene::MagnetShape& shape, v1::World::Magnet& to) {
  switch (shape.kind) {
    case scene::MagnetShape::Kind::box:
      return add(shape.size, *to.mutable_box()->mutable_size());
    case scene::MagnetShape::Kind::cylinder:
      to.mutable_cylinder()->set_radius(shape.radius);
      return to.mutable_cylinder()->set_height(shape.height);
    case scene::MagnetShape::Kind::sphere:
      return to.mutable_sphere()->set_radius(shape.radius);
  }
}

void describe_magnets(const Population& from, v1::World& to) {
  std::size_t place = 0;
  for (const scene::Entity& entity : from.entities) {
    for (const scene::Magnet& magnet : entity.devices.magnets) {
      const world::MagnetLayout& layout = from.layout.magnets[place++];
      v1::World::Magnet& described = *to.add_magnets();
      described.set_id(v1::valid_utf8(layout.id));
      described.set_entity(index(layout.mount.entity));
      world::Mount mount = layout.mount;
      if (magnet.shape) {
        mount.pose.orientation = mount.pose.orientation * magnet.shape->orientation;
        set_shape(*magnet.shape, described);
      }
      set_mount(from, mount, *described.mutable_mount());
    }
  }
}

}  // namespace

void describe_devices(const Population& from, v1::World& to) {
  const world::Layout& layout = from.layout;
  for (std::size_t robot = 0; robot < layout.robots.size(); ++robot) {
    describe_cameras(from, robot, to);
    describe_radios(from, robot, to);
  }
  for (const world::LedLayout& led : layout.leds) describe_led(from, led, *to.add_leds());
  for (const world::DirectionalLedLayout& led : layout.directional_leds) {
    v1::World::Led& described = *to.add_directional_leds();
    describe_led(from, led, described);
    described.set_observable_angle(led.observable_angle);
  }
  describe_tags(from, to);
  describe_magnets(from, to);
  for (const world::RangeAndBearingLayout& device : layout.range_and_bearing) {
    v1::World::RangeAndBearing& described = *to.add_range_and_bearing();
    described.set_entity(index(device.mount.entity));
    const auto& entity = to.entities(static_cast<int>(device.mount.entity));
    if (entity.has_robot()) described.set_robot(entity.robot());
    set_mount(from, device.mount, *described.mutable_mount());
    described.set_range(device.range);
  }
}

}  // namespace ziggurat::channels
