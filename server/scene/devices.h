// SPDX-License-Identifier: MIT
#pragma once
// Devices: what an entity carries (Devices) and what a controller enables (ControllerDevices).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "math/pose.h"
#include "scene/problem.h"

namespace ziggurat::scene {

/// Mount of a device: a link, or the entity's origin frame.
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
  math::Vector3 offset = math::Vector3::Zero();  ///< in the anchor frame [m]
  Color color;                                   ///< black is off
  Location where;
};

struct DirectionalLed {
  std::string id;
  Anchor anchor;
  math::Pose pose;              ///< in the anchor frame; +z is the direction of emission
  double observable_angle = 0;  ///< half-angle about +z [rad]
  Color color;
  Location where;
};

struct Tag {
  std::string id;
  Anchor anchor;
  math::Pose pose;              ///< in the anchor frame; +z is the normal
  double observable_angle = 0;  ///< half-angle about +z [rad]
  double side_length = 0;       ///< [m]
  std::string payload;
  Location where;
};

struct Radio {
  std::string id;
  Anchor anchor;
  math::Vector3 position = math::Vector3::Zero();  ///< in the anchor frame [m]
  double range = 0;                                ///< of sending [m]
  Location where;
};

/// The body of a magnet that is uniformly magnetised, centred on the magnet's offset.
struct MagnetShape {
  enum class Kind { box, cylinder, sphere } kind = Kind::sphere;
  math::Vector3 size = math::Vector3::Zero();                   ///< of a box: full extents [m]
  double radius = 0;                                            ///< of a cylinder or sphere [m]
  double height = 0;                                            ///< of a cylinder, along its z [m]
  math::Quaternion orientation = math::Quaternion::Identity();  ///< in the anchor frame
};

struct Magnet {
  std::string id;
  Anchor anchor;
  math::Vector3 offset = math::Vector3::Zero();         ///< in the anchor frame [m]
  math::Vector3 passive_field = math::Vector3::Zero();  ///< the dialect's unit (docs/magnetism.md)
  math::Vector3 active_field = math::Vector3::Zero();   ///< added per unit of current
  Location where;
  std::optional<MagnetShape> shape;                 ///< none: a point
  math::Vector3 moment = math::Vector3::Zero();     ///< added to the passive one [A m^2]
  math::Vector3 remanence = math::Vector3::Zero();  ///< likewise, times the shape's volume [T]
};

/// Reading of a proximity sensor over distance, from its data sheet: straight lines between the
/// points, level outside of them.
struct Response {
  struct Point {
    double distance = 0;  ///< [m], >= 0
    double reading = 0;   ///< in the sensor's own unit
  };
  std::vector<Point> points;  ///< ascending by distance; at least one
};

struct ProximitySensor {
  Anchor anchor;
  math::Vector3 offset = math::Vector3::Zero();     ///< start of the ray in the anchor frame [m]
  math::Vector3 direction = math::Vector3::Zero();  ///< unit, in the anchor frame
  double range = 0;                                 ///< length of the ray [m]
  std::optional<bool> sees_floor;                   ///< none: that of the controller's sensor
  std::optional<Response> response;                 ///< none: that of the controller's sensor
  Location where;
};

constexpr unsigned most_data_bytes = 65'536;  ///< of a range-and-bearing packet

/// Sends its position and some bytes to others in line of sight, and receives theirs.
struct RangeAndBearing {
  Anchor anchor;
  math::Pose pose;         ///< in the anchor frame; bearings are relative to it
  double range = 0;        ///< of sending [m]
  unsigned data_size = 0;  ///< [bytes] of every packet; only equal sizes hear each other
  Location where;
};

/// Loses charge with time, with motion of the entity's origin, or with both. It is counted in any
/// unit; what robots see is its share of full_charge.
struct Battery {
  double full_charge = 1;   ///< > 0
  double start_charge = 1;  ///< 0 ... full_charge
  double per_tick = 0;      ///< lost at every tick
  double per_metre = 0;     ///< lost per metre of displacement in a tick
  double per_radian = 0;    ///< lost per radian of rotation in a tick
  Location where;
};

/// Place on a robot for devices that describe themselves.
struct DevicePlace {
  std::string_view name;  ///< of all places that a sensor uses: "light"
  Anchor anchor;
  math::Pose pose;               ///< in the anchor frame
  std::vector<double> settings;  ///< their meaning is the kind's
};

/// Devices of an entity. Containers keep document order. A container's medium is an index into
/// Scene::media.
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
  std::optional<RangeAndBearing> range_and_bearing;
  std::optional<std::size_t> range_and_bearing_medium;
  std::optional<Battery> battery;
  std::vector<DevicePlace> places;
};

enum class JointMode { disabled, position, velocity };

struct JointActuator {
  std::string joint;  ///< id; resolved against each entity that uses the controller
  JointMode mode = JointMode::disabled;
  double max_impulse = 0;  ///< [N s] (prismatic) or [N m s] (revolute) per substep
  Location where;
  /// Instead of max_impulse, whatever the substep: [N] (prismatic) or [N m] (revolute).
  std::optional<double> max_force = {};
  bool is_torque = false;  ///< max_force was written as max_torque
};

struct JointSensor {
  std::string joint;
  JointMode mode = JointMode::disabled;
  Location where;
};

struct Detector {
  enum class Kind { led, directional_led, tag } kind;
  std::size_t medium = 0;  ///< index into Scene::media
  bool show_rays = false;
  Location where;
};

struct Camera {
  std::string id;
  std::string anchor;        ///< resolved against each entity that uses the controller
  math::Pose pose;           ///< in the anchor frame; +z forward, +x right, +y down
  double near = 0, far = 0;  ///< range along the optical axis [m]
  math::Vector2 focal_length = math::Vector2::Zero();     ///< fx, fy [px]
  math::Vector2 principal_point = math::Vector2::Zero();  ///< cx, cy [px]
  std::array<unsigned, 2> resolution{};                   ///< width, height [px]
  bool image = false;                                     ///< it takes a picture at every tick
  std::vector<Detector> detectors;
  Location where;
};

/// An accelerometer and a gyroscope. Each axis of each has white noise and a bias that starts at 0
/// and walks: its change in a time t has a standard deviation of `…_bias_walk` times the root of t.
struct Imu {
  std::string id;
  std::string anchor;                     ///< resolved against each entity of the controller
  math::Pose pose;                        ///< in the anchor frame
  double acceleration_noise = 0;          ///< standard deviation [m/s^2]
  double acceleration_bias_walk = 0;      ///< [m/s^2/sqrt(s)]
  double angular_velocity_noise = 0;      ///< standard deviation [rad/s]
  double angular_velocity_bias_walk = 0;  ///< [rad/s/sqrt(s)]
};

/// Feels what touches a link.
struct ContactSensor {
  std::string id;
  std::string anchor;  ///< resolved against each entity of the controller; origin: the root link
};

/// An offset drawn uniformly from [min, max].
struct NoiseRange {
  double min = 0, max = 0;
};

/// The error of a wheel: it runs at factor * (speed + bias).
struct WheelNoise {
  double bias_mean = 0, bias_deviation = 0;      ///< drawn once per robot [m/s]
  double factor_mean = 1, factor_deviation = 0;  ///< drawn at every tick
};

// --- what a controller enables, one struct per kind ---------------------------------------------

struct JointsUse {
  std::vector<JointActuator> actuators;
  std::vector<JointSensor> sensors;
};

struct RadiosUse {
  bool actuator = false, sensor = false;
  bool show_rays = false;
};

struct LedsUse {
  std::optional<std::size_t> medium;  ///< the actuator assigns all LEDs to it
};

struct ProximityUse {
  bool footbot = false;  ///< the sensor is the foot-bot's own: its response, with angles
  bool show_rays = false;
  double noise = 0;                  ///< uniform in ± this, >= 0
  bool sees_floor = false;           ///< of sensors that leave it open
  std::optional<Response> response;  ///< of sensors that leave it open; none: exp(-distance)
};

struct RangeAndBearingUse {
  bool actuator = false, sensor = false;
  std::optional<std::size_t> medium;  ///< the sensor assigns the device to it
  bool show_rays = false;
  double noise = 0;  ///< standard deviation of the length by which the other is elsewhere [m]
  double loss = 0;   ///< probability that a packet is lost, 0 ... 1
};

struct PositioningUse {
  NoiseRange position;  ///< of each coordinate [m]
  NoiseRange angle;     ///< of the angle of rotation [rad]
  NoiseRange axis;      ///< of each coordinate of the unit axis of rotation
};

struct BatteryUse {
  NoiseRange charge;  ///< of the share that is left
};

struct WheelsUse {
  bool actuator = false;
  std::array<WheelNoise, 2> noise;  ///< left, right
  bool sensor = false;
  NoiseRange velocity_noise;  ///< [m/s]
  NoiseRange distance_noise;  ///< [m]
};

struct TurretUse {
  bool actuator = false, encoder = false;
};

struct CamerasUse {
  bool show_frustum = false;
  std::vector<Camera> cameras;
};

/// A device that describes itself (world/described.h), as a controller enables it.
struct DescribedUse {
  std::string_view kind;    ///< of the table of all devices: several elements may be of one
  std::string_view places;  ///< name of the places that it uses
  bool actuator = false, sensor = false;
  bool show_rays = false;
  double noise = 0;                   ///< in the kind's unit, >= 0
  double strength = 0;                ///< likewise
  double loss = 0;                    ///< probability that a message is lost, 0 ... 1
  std::optional<std::size_t> medium;  ///< index into Scene::media
};

/// Devices that a controller's <actuators> and <sensors> enable. Kinds without settings are a bool.
struct ControllerDevices {
  JointsUse joints;
  std::optional<RadiosUse> radios;
  std::optional<LedsUse> leds;
  bool directional_leds = false;
  bool tags = false;
  bool magnets = false;
  bool draws_markers = false;  ///< the actuator `debug`
  std::optional<ProximityUse> proximity;
  std::optional<RangeAndBearingUse> range_and_bearing;
  std::optional<PositioningUse> positioning;
  std::optional<BatteryUse> battery;
  std::optional<WheelsUse> wheels;
  std::optional<TurretUse> turret;
  std::optional<CamerasUse> cameras;
  std::vector<Imu> imus;
  std::vector<ContactSensor> contact_sensors;
  std::vector<DescribedUse> described;
  /// About what those that are fixed to an anchor take in each robot [bytes].
  std::size_t mounted_memory = 0;
};

/// The id of AprilTag's family 36h11 that a payload stands for: all of it is an integer 0 to 586.
std::optional<unsigned> tag_pattern(std::string_view payload);

}  // namespace ziggurat::scene
