#pragma once
// Devices: what an entity carries (Devices) and what a controller enables (ControllerDevices).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/pose.h"
#include "scene/location.h"

namespace ziggurat::scene {

/// Where a device is fixed: a link, or the entity's origin frame.
struct Anchor {
  static constexpr int origin = -1;
  int link = origin;  ///< index into Entity::links, or `origin`
};

struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Color&) const = default;
};

struct Led {
  std::string id;
  Anchor anchor;
  math::Vector3 offset;  ///< in the anchor frame [m]
  Color color;           ///< black is off
  Location where;
};

struct DirectionalLed {
  std::string id;
  Anchor anchor;
  math::Pose pose;          ///< in the anchor frame; +z is the direction of emission
  double observable_angle;  ///< half-angle about +z [rad]
  Color color;
  Location where;
};

struct Tag {
  std::string id;
  Anchor anchor;
  math::Pose pose;          ///< in the anchor frame; +z is the normal
  double observable_angle;  ///< half-angle about +z [rad]
  double side_length;       ///< [m]
  std::string payload;
  Location where;
};

struct Radio {
  std::string id;
  Anchor anchor;
  math::Vector3 position;  ///< in the anchor frame [m]
  double range;            ///< of sending [m]
  Location where;
};

struct Magnet {
  std::string id;
  Anchor anchor;
  math::Vector3 offset;         ///< in the anchor frame [m]
  math::Vector3 passive_field;  ///< the dialect's unit (see docs/magnetism.md)
  math::Vector3 active_field = math::Vector3::Zero();  ///< added per unit of current
  Location where;
};

struct ProximitySensor {
  Anchor anchor;
  math::Vector3 offset;     ///< start of the ray in the anchor frame [m]
  math::Vector3 direction;  ///< unit, in the anchor frame
  double range;             ///< length of the ray [m]
  Location where;
};

/// What an entity carries. Containers keep document order. A container's medium is an index
/// into Scene::media.
struct Devices {
  std::vector<Led> leds;
  std::optional<std::size_t> led_medium;
  std::vector<DirectionalLed> directional_leds;
  std::optional<std::size_t> directional_led_medium;
  std::vector<Tag> tags;
  std::optional<std::size_t> tag_medium;
  std::vector<Radio> radios;
  std::optional<std::size_t> radio_medium;
  std::vector<Magnet> magnets;
  std::vector<ProximitySensor> proximity_sensors;
};

enum class JointMode { disabled, position, velocity };

struct JointActuator {
  std::string joint;  ///< id; resolved against each entity that uses the controller
  JointMode mode = JointMode::disabled;
  double max_impulse = 0;  ///< [N s] (prismatic) or [N m s] (revolute) per substep
  Location where;
};

struct JointSensor {
  std::string joint;
  JointMode mode = JointMode::disabled;
  Location where;
};

struct Detector {
  enum class Kind { led, directional_led, tag } kind;
  std::size_t medium;  ///< index into Scene::media
  bool show_rays = false;
  Location where;
};

struct Camera {
  std::string id;
  std::string anchor;       ///< resolved against each entity that uses the controller
  math::Pose pose;          ///< in the anchor frame; +z forward, +x right, +y down
  double near = 0, far = 0; ///< range along the optical axis [m]
  math::Vector2 focal_length;     ///< fx, fy [px]
  math::Vector2 principal_point;  ///< cx, cy [px]
  std::array<unsigned, 2> resolution{};  ///< width, height [px]
  std::vector<Detector> detectors;
  Location where;
};

/// What a controller's <actuators> and <sensors> enable.
struct ControllerDevices {
  std::vector<JointActuator> joint_actuators;
  std::vector<JointSensor> joint_sensors;
  bool radios_actuator = false;
  bool radios_sensor = false;
  bool radios_show_rays = false;
  bool leds_actuator = false;
  std::optional<std::size_t> leds_medium;  ///< the actuator assigns all LEDs to it
  bool directional_leds_actuator = false;
  bool tags_actuator = false;
  bool magnets_actuator = false;
  bool proximity_sensor = false;
  bool proximity_show_rays = false;
  double proximity_noise = 0;  ///< uniform in ± this, >= 0
  bool cameras_show_frustum = false;
  std::vector<Camera> cameras;
};

}  // namespace ziggurat::scene
