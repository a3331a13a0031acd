// SPDX-License-Identifier: MIT
#pragma once
// Each kind of device in the world: what does not change while the world runs (…Layout), and what a
// robot senses (Observations). All arrays are in scene order and indexed by the lists of Layout. A
// field of Observations has its row in the table below it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "math/pose.h"
#include "world/channel.h"
#include "world/color.h"
#include "world/described.h"
#include "world/mount.h"
#include "world/radio_messages.h"

namespace ziggurat::world {

// --- layout -------------------------------------------------------------------------------------

/// A joint with an encoder: an entry of Observations::joint_readings.
struct JointSensorLayout {
  std::string id;
  bool velocity = false;  ///< reads q' [m/s, rad/s] instead of q [m, rad]
  bool disabled = false;  ///< always reads 0
};

/// A joint with a motor: an entry of Commands::joint_targets.
struct JointActuatorLayout {
  std::string id;
  bool velocity = false;
  bool disabled = false;   ///< targets are accepted and have no effect
  double max_impulse = 0;  ///< per substep [N s, N m s]: as written, or from the force
};

/// A radio of a robot whose controller enables radios.
struct RadioLayout {
  std::string id;
  Mount mount;
  double range = 0;        ///< of sending [m]; a receiver must be strictly closer
  std::size_t medium = 0;  ///< into scene::Scene::media
  bool sends = false;      ///< its controller has the actuator
  bool receives = false;   ///< its controller has the sensor
  bool shows_links = false;
};

/// An LED of any entity.
struct LedLayout {
  std::string id;
  Mount mount;
  std::size_t medium = 0;
  Color color = 0;  ///< at the start
};

/// A directional LED of any entity; +z of its frame is the direction of emission.
struct DirectionalLedLayout {
  std::string id;
  Mount mount;
  std::size_t medium = 0;
  double observable_angle = 0;  ///< half-angle about +z [rad]
  Color color = 0;              ///< at the start
};

/// A tag of any entity; +z of its frame is the normal.
struct TagLayout {
  std::string id;
  Mount mount;
  std::size_t medium = 0;
  double observable_angle = 0;  ///< half-angle about +z [rad]
  double side_length = 0;       ///< [m]
  std::string payload;          ///< at the start
};

/// A magnet of any entity. Its field is passive_field + current * active_field.
struct MagnetLayout {
  std::string id;
  Mount mount;
  math::Vector3 passive_field = math::Vector3::Zero();  ///< anchor frame, the dialect's unit
  math::Vector3 active_field = math::Vector3::Zero();   ///< per unit of current
};

/// A ray of a robot whose controller enables proximity.
struct ProximityLayout {
  Mount mount;                                       ///< its origin is the start of the ray
  math::Vector3 direction = math::Vector3::UnitX();  ///< unit, in the anchor frame
  double range = 0;                                  ///< length of the ray [m]
  std::optional<double> angle;  ///< about +z from +x, (-pi, pi] [rad]; only of the foot-bot's own
                                ///< sensors, which report it with each value
};

/// A range-and-bearing device of any entity: at most one each.
struct RangeAndBearingLayout {
  Mount mount;       ///< bearings are relative to its frame
  double range = 0;  ///< of sending [m]; a receiver must be strictly closer
  std::size_t medium = 0;
  Range data;             ///< its bytes in State::, Commands::range_and_bearing_data
  bool sends = false;     ///< its controller has the actuator; without it, it sends zeros
  bool receives = false;  ///< its controller has the sensor
};

/// A battery of a robot whose controller has the sensor.
struct BatteryLayout {
  std::size_t entity = 0;
};

/// Targets of a camera's detector, and their medium.
struct DetectorLayout {
  std::size_t medium = 0;   ///< into scene::Scene::media
  bool shows_rays = false;  ///< its lines of sight go to State::rays
};

/// A pinhole camera of a robot whose controller has the sensor. Its frame has +z forward, +x right
/// and +y down. A point (X, Y, Z) of it is seen at u = fx X/Z + cx, v = fy Y/Z + cy. These are real
/// pixels from the image's top left corner, u to the right, v down.
struct CameraLayout {
  std::string id;
  Mount mount;
  double near = 0, far = 0;              ///< range along the optical axis [m]
  math::Vector2 focal_length{1, 1};      ///< fx, fy [px]
  math::Vector2 principal_point{0, 0};   ///< cx, cy [px]
  std::array<unsigned, 2> resolution{};  ///< width, height [px]
  std::optional<DetectorLayout> leds, directional_leds, tags;
  bool shows_frustum = false;  ///< its frustum goes to State::frusta
  bool image = false;          ///< it also takes a picture: an entry of Observations::images
};

/// Two driven wheels of a robot whose controller has the actuator, the sensor or both.
struct WheelsLayout {
  std::size_t entity = 0;
  double axle_length = 0;  ///< distance between the wheels [m]
  bool drives = false;     ///< its controller has the actuator
  bool measures = false;   ///< its controller has the sensor
};

/// A rotating turret of a robot whose controller has the actuator, the encoder or both.
struct TurretLayout {
  std::size_t entity = 0;
  bool drives = false;    ///< its controller has the actuator
  bool measures = false;  ///< its controller has the encoder
};

/// An inertial measurement unit of a robot whose controller has the sensor.
struct ImuLayout {
  std::string id;
  Mount mount;  ///< readings are in its frame
};

/// A contact sensor of a robot whose controller has the sensor.
struct ContactSensorLayout {
  std::string id;
  std::string anchor;      ///< of the scene: id of a link, or `origin`
  std::size_t entity = 0;  ///< into Layout::entities
  std::size_t link = 0;    ///< into State::links; readings are in its frame
};

/// All devices of the world, kind by kind.
struct DeviceLists {
  std::vector<JointSensorLayout> joint_sensors;
  std::vector<JointActuatorLayout> joint_actuators;
  std::vector<RadioLayout> radios;
  std::vector<LedLayout> leds;
  std::vector<DirectionalLedLayout> directional_leds;
  std::vector<TagLayout> tags;
  std::vector<MagnetLayout> magnets;
  std::vector<ProximityLayout> proximity;
  std::vector<RangeAndBearingLayout> range_and_bearing;
  std::vector<std::size_t> positioning;  ///< the entity of each sensor
  std::vector<BatteryLayout> batteries;
  std::vector<CameraLayout> cameras;
  std::vector<WheelsLayout> wheels;
  std::vector<TurretLayout> turrets;
  std::vector<ImuLayout> imus;
  std::vector<ContactSensorLayout> contact_sensors;
  std::vector<DescribedDevice> described;             ///< robot by robot, kind by kind
  std::size_t device_readings = 0, device_lists = 0;  ///< values and lists of all of them
  std::vector<const DeviceCommand*> device_commands;  ///< field of each of their commands
};

/// Devices of one robot: into the list of the same name. Empty unless its controller enables them.
/// A robot has at most one of range and bearing, positioning, batteries, wheels and turrets.
struct DeviceRanges {
  Range joint_sensors, joint_actuators;
  Range radios;
  Range leds, directional_leds, tags;
  Range magnets;
  Range proximity;
  Range range_and_bearing;
  Range positioning;
  Range batteries;
  Range cameras;
  Range wheels;
  Range turrets;
  Range imus;
  Range contact_sensors;
  Range described;
  Range device_readings, device_lists, device_commands;  ///< of the described ones
};

// --- what a robot senses ------------------------------------------------------------------------

/// A packet that a range-and-bearing device received.
struct RangeAndBearingPacket {
  std::size_t receiver = 0;       ///< into Layout::range_and_bearing
  double range = 0;               ///< distance between the two devices, with the sensor's noise [m]
  double horizontal_bearing = 0;  ///< about +z of the receiver's frame from +x, (-pi, pi] [rad]
  double vertical_bearing = 0;    ///< above its xy plane, [-pi/2, pi/2] [rad]
  Range data;                     ///< into Observations::range_and_bearing_data; the receiver's
                                  ///< own number of bytes
  std::size_t sender = 0;         ///< into Layout::range_and_bearing; no robot is told
};

struct BatteryReading {
  double available_charge = 1;  ///< share of the full charge, 0 ... 1
  double time_left = 0;         ///< at the rate of the last tick [s]; infinite if nothing is drawn
};

/// A lit LED in the image of a camera.
struct LedReading {
  std::size_t camera = 0;  ///< into Layout::cameras
  Color color = 0;
  math::Vector2 center{0, 0};  ///< [px]
};

/// A tag in the image of a camera.
struct TagReading {
  std::size_t camera = 0;                ///< into Layout::cameras
  std::size_t tag = 0;                   ///< into Layout::tags; its payload is that of State
  math::Vector2 center{0, 0};            ///< [px]
  std::array<math::Vector2, 4> corners;  ///< [px] of (-,-), (-,+), (+,+), (+,-) half a side in the
                                         ///< tag's frame
};

/// Wheels with an encoder.
struct WheelsReading {
  double velocity_left = 0, velocity_right = 0;  ///< as commanded, with the sensor's noise [m/s]
  double distance_left = 0, distance_right = 0;  ///< in the last tick, with the sensor's noise [m]
};

/// In the frame of the sensor, means over the last tick.
struct ImuReading {
  /// Specific force of an accelerometer [m/s^2]: acceleration minus that of free fall. At rest it
  /// points up with the strength of gravity, in free fall it is 0.
  std::array<double, 3> acceleration{};
  std::array<double, 3> angular_velocity{};  ///< relative to the world [rad/s]
};

/// Contacts of a link during the last tick, with other entities and the floor.
struct ContactReading {
  double touches = 0;             ///< 1: something did, if only for a substep; 0: nothing
  std::array<double, 3> force{};  ///< sum of all contact forces on the link, normal and friction,
                                  ///< mean over the tick, in the link's frame [N]
  double strength = 0;  ///< sum of their absolute values [N]: more than that of `force` where
                        ///< contacts press against each other
};

/// A picture that a camera took: rows from top to bottom, pixels from left to right, red, green
/// and blue of one byte each. Empty at tick 0.
struct Image {
  std::size_t camera = 0;  ///< into Layout::cameras
  std::vector<std::uint8_t> rgb;
};

/// Readings of all robots at one tick.
struct Observations {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::vector<double> joint_readings;  ///< [m], [rad], [m/s] or [rad/s] by the sensor's mode
  RadioMessages radio_messages;   ///< received since the last tick: entries ascend by receiver;
                                  ///< for each, by sender, then in the order of sending
  std::vector<double> proximity;  ///< 0 (nothing) ... 1, or a value of the sensor's response
  std::vector<RangeAndBearingPacket> range_and_bearing;  ///< ascending by receiver, then by sender
  std::vector<std::uint8_t> range_and_bearing_data;      ///< of all packets
  std::vector<math::Pose> positioning;                   ///< X_WE, with the sensor's noise
  std::vector<BatteryReading> batteries;
  std::vector<LedReading> leds;              ///< ascending by camera, then in scene order
  std::vector<LedReading> directional_leds;  ///< likewise
  std::vector<TagReading> tags;              ///< likewise
  std::vector<WheelsReading> wheels;         ///< zeros where the controller has no sensor
  std::vector<double> turrets;               ///< about +z of the robot's origin, [-pi, pi] [rad]
  std::vector<ImuReading> imus;
  std::vector<ContactReading> contact_sensors;
  std::vector<Image> images;            ///< of cameras that take pictures
  std::vector<double> device_readings;  ///< of described devices without rows
  std::vector<DeviceRows> device_rows;  ///< of each described device with rows
};

// clang-format off
inline constexpr std::tuple sensed{
    ByHand{&Observations::tick, Hashed::no},
    ByHand{&Observations::time_ns, Hashed::no},
    Sensed<double>{&Observations::joint_readings, "joint_encoders", all<&Ranges::joint_sensors>,
                   id<&Lists::joint_sensors>, Hashed::first},
    ByHand{&Observations::radio_messages, Hashed::second},
    Sensed<double>{&Observations::proximity, "proximity", all<&Ranges::proximity>},
    ByHand{&Observations::range_and_bearing, Hashed::second},
    ByHand{&Observations::range_and_bearing_data, Hashed::no},  // with the packets
    Sensed<math::Pose>{&Observations::positioning, "positioning", all<&Ranges::positioning>},
    Sensed<BatteryReading>{&Observations::batteries, "battery", all<&Ranges::batteries>},
    Sensed<WheelsReading>{&Observations::wheels, "wheels",
                          one_if<&Ranges::wheels, &Lists::wheels, &WheelsLayout::measures>},
    Sensed<double>{&Observations::turrets, "turret_rotation",
                   one_if<&Ranges::turrets, &Lists::turrets, &TurretLayout::measures>},
    ByHand{&Observations::leds, Hashed::second},
    ByHand{&Observations::directional_leds, Hashed::second},
    ByHand{&Observations::tags, Hashed::second},
    Sensed<ImuReading>{&Observations::imus, "imus", all<&Ranges::imus>, id<&Lists::imus>},
    Sensed<ContactReading>{&Observations::contact_sensors, "contact_sensors",
                           all<&Ranges::contact_sensors>, id<&Lists::contact_sensors>},
    ByHand{&Observations::images, Hashed::no},
    Sensed<double>{&Observations::device_readings, nullptr, all<&Ranges::device_readings>},
    ByHand{&Observations::device_rows, Hashed::second},
};
// clang-format on

}  // namespace ziggurat::world
