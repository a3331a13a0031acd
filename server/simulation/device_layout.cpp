#include "simulation/device_layout.h"

#include <cmath>

namespace ziggurat::simulation {
namespace {

using world::Layout;
using world::Range;
using world::RobotLayout;

world::Color packed(const scene::Color& color) {
  return (world::Color{color.red} << 16) | (world::Color{color.green} << 8) | color.blue;
}

world::Mount mount(const DeviceCarrier& carrier, const scene::Anchor& anchor,
                   const math::Pose& pose, const Layout& layout) {
  world::Mount result{carrier.index, std::nullopt, pose};
  if (anchor.link != scene::Anchor::origin) {
    result.link =
        layout.entities[carrier.index].links.begin + static_cast<std::size_t>(anchor.link);
  }
  return result;
}

world::Mount mount(const DeviceCarrier& carrier, const scene::Anchor& anchor,
                   const math::Vector3& position, const Layout& layout) {
  return mount(carrier, anchor, math::Pose{position, math::Quaternion::Identity()}, layout);
}

/// The devices from `begin` on if the controller enables them.
template <class List>
Range enabled_range(bool enabled, std::size_t begin, const List& list) {
  return {begin, enabled ? list.size() - begin : 0};
}

void add_radios(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  robot.radios.begin = layout.radios.size();
  if (!enabled.radios_actuator && !enabled.radios_sensor) return;
  for (const scene::Radio& radio : entity.devices.radios) {
    layout.radios.push_back({radio.id, mount(carrier, radio.anchor, radio.position, layout),
                             radio.range, entity.devices.radio_medium.value_or(0),
                             enabled.radios_actuator, enabled.radios_sensor,
                             enabled.radios_show_rays});
  }
  robot.radios.count = entity.devices.radios.size();
}

void add_leds(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  const std::size_t begin = layout.leds.size();
  const std::size_t own_medium = entity.devices.led_medium.value_or(0);
  for (const scene::Led& led : entity.devices.leds) {
    layout.leds.push_back({led.id, mount(carrier, led.anchor, led.offset, layout),
                           enabled.leds_medium.value_or(own_medium), packed(led.color)});
  }
  layout.entities[index].leds = {begin, layout.leds.size() - begin};
  robot.leds = enabled_range(enabled.leds_actuator, begin, layout.leds);
}

void add_directional_leds(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  const std::size_t begin = layout.directional_leds.size();
  for (const scene::DirectionalLed& led : entity.devices.directional_leds) {
    layout.directional_leds.push_back({led.id, mount(carrier, led.anchor, led.pose, layout),
                                       entity.devices.directional_led_medium.value_or(0),
                                       led.observable_angle, packed(led.color)});
  }
  layout.entities[index].directional_leds = {begin, layout.directional_leds.size() - begin};
  robot.directional_leds =
      enabled_range(enabled.directional_leds_actuator, begin, layout.directional_leds);
}

void add_tags(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  const std::size_t begin = layout.tags.size();
  for (const scene::Tag& tag : entity.devices.tags) {
    layout.tags.push_back({tag.id, mount(carrier, tag.anchor, tag.pose, layout),
                           entity.devices.tag_medium.value_or(0), tag.observable_angle,
                           tag.side_length, tag.payload});
  }
  layout.entities[index].tags = {begin, layout.tags.size() - begin};
  robot.tags = enabled_range(enabled.tags_actuator, begin, layout.tags);
}

void add_magnets(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  const std::size_t begin = layout.magnets.size();
  for (const scene::Magnet& magnet : entity.devices.magnets) {
    layout.magnets.push_back({magnet.id, mount(carrier, magnet.anchor, magnet.offset, layout),
                              magnet.passive_field, magnet.active_field});
  }
  robot.magnets = enabled_range(enabled.magnets_actuator, begin, layout.magnets);
}

void add_proximity(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  robot.proximity.begin = layout.proximity.size();
  if (!enabled.proximity_sensor) return;
  for (const scene::ProximitySensor& sensor : entity.devices.proximity_sensors) {
    layout.proximity.push_back(
        {mount(carrier, sensor.anchor, sensor.offset, layout), sensor.direction, sensor.range, {}});
    if (!enabled.footbot_proximity) continue;
    layout.proximity.back().angle = std::atan2(sensor.direction.y(), sensor.direction.x());
  }
  robot.proximity.count = entity.devices.proximity_sensors.size();
}

void add_range_and_bearing(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  auto& devices = layout.range_and_bearing;
  const std::size_t begin = devices.size();
  if (const auto& device = entity.devices.range_and_bearing) {
    const std::size_t medium = entity.devices.range_and_bearing_medium.value_or(0);
    const Range data{devices.empty() ? 0 : devices.back().data.end(), device->data_size};
    devices.push_back({mount(carrier, device->anchor, device->pose, layout), device->range,
                       enabled.range_and_bearing_medium.value_or(medium), data,
                       enabled.range_and_bearing_actuator, enabled.range_and_bearing_sensor});
  }
  robot.range_and_bearing = enabled_range(
      enabled.range_and_bearing_actuator || enabled.range_and_bearing_sensor, begin, devices);
}

world::CameraLayout camera_layout(const DeviceCarrier& carrier, const scene::Camera& from,
                                  const Layout& layout) {
  scene::Anchor anchor;
  for (std::size_t i = 0; i < carrier.entity.links.size(); ++i) {
    if (carrier.entity.links[i].id == from.anchor) anchor.link = static_cast<int>(i);
  }
  world::CameraLayout camera;
  camera.id = from.id;
  camera.mount = mount(carrier, anchor, from.pose, layout);
  camera.near = from.near;
  camera.far = from.far;
  camera.focal_length = from.focal_length;
  camera.principal_point = from.principal_point;
  camera.resolution = from.resolution;
  for (const scene::Detector& detector : from.detectors) {
    const world::DetectorLayout looks{detector.medium, detector.show_rays};
    switch (detector.kind) {
      case scene::Detector::Kind::led:
        camera.leds = looks;
        break;
      case scene::Detector::Kind::directional_led:
        camera.directional_leds = looks;
        break;
      case scene::Detector::Kind::tag:
        camera.tags = looks;
        break;
    }
  }
  camera.shows_frustum = carrier.enabled.cameras_show_frustum;
  camera.image = from.image;
  return camera;
}

void add_cameras(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  robot.cameras.begin = layout.cameras.size();
  for (const scene::Camera& camera : carrier.enabled.cameras) {
    layout.cameras.push_back(camera_layout(carrier, camera, layout));
  }
  robot.cameras.count = carrier.enabled.cameras.size();
}

void add_state_sensors(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  robot.positioning = {layout.positioning.size(), carrier.enabled.positioning_sensor ? 1u : 0u};
  if (carrier.enabled.positioning_sensor) layout.positioning.push_back(carrier.index);
  const bool battery = carrier.enabled.battery_sensor && carrier.entity.devices.battery;
  robot.batteries = {layout.batteries.size(), battery ? 1u : 0u};
  if (battery) layout.batteries.push_back({carrier.index});
}

void add_wheels_and_turret(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  const auto& [entity, index, enabled] = carrier;
  const bool wheels = entity.axle_length && (enabled.wheels_actuator || enabled.wheels_sensor);
  robot.wheels = {layout.wheels.size(), wheels ? 1u : 0u};
  if (wheels) {
    layout.wheels.push_back(
        {index, *entity.axle_length, enabled.wheels_actuator, enabled.wheels_sensor});
  }
  const bool turret = entity.turret && (enabled.turret_actuator || enabled.turret_encoder);
  robot.turrets = {layout.turrets.size(), turret ? 1u : 0u};
  if (turret) layout.turrets.push_back({index, enabled.turret_actuator, enabled.turret_encoder});
}

}  // namespace

void add_devices(const DeviceCarrier& carrier, RobotLayout& robot, Layout& layout) {
  add_radios(carrier, robot, layout);
  add_leds(carrier, robot, layout);
  add_directional_leds(carrier, robot, layout);
  add_tags(carrier, robot, layout);
  add_magnets(carrier, robot, layout);
  add_proximity(carrier, robot, layout);
  add_range_and_bearing(carrier, robot, layout);
  add_cameras(carrier, robot, layout);
  add_state_sensors(carrier, robot, layout);
  add_wheels_and_turret(carrier, robot, layout);
}

}  // namespace ziggurat::simulation
