#pragma once
// Who is in the world, in scene order: the names and positions that every flat array of State,
// Observations and Commands is indexed by. While a world runs it only grows: who comes stands
// behind all others, who goes leaves its places empty (State::absent).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/pose.h"

namespace ziggurat::world {

/// A run of elements in a flat array.
struct Range {
  std::size_t begin = 0;
  std::size_t count = 0;
  std::size_t end() const { return begin + count; }
};

struct EntityLayout {
  std::string id;
  Range links;                  ///< into State::links; every entity has at least one
  bool lists_links = false;     ///< a trace has a row per link (prototypes and robots)
  Range leds = {};              ///< all that it carries, whoever sets them: into Layout::leds,
  Range directional_leds = {};  ///< directional_leds
  Range tags = {};              ///< and tags
};

struct LinkLayout {
  std::string id;  ///< empty for a box or cylinder entity
  std::size_t entity = 0;
};

/// A readable joint: an entry of Observations::joint_readings.
struct JointSensorLayout {
  std::string id;
  bool velocity = false;  ///< reads q' [m/s, rad/s] instead of q [m, rad]
  bool disabled = false;  ///< always reads 0
};

/// A settable joint: an entry of Commands::joint_targets.
struct JointActuatorLayout {
  std::string id;
  bool velocity = false;
  bool disabled = false;   ///< targets are accepted and have no effect
  double max_impulse = 0;  ///< per substep as written in the scene [N s, N m s]
};

/// A colour as 0xRRGGBB. 0 is off: nothing sees it.
using Color = std::uint32_t;

/// Where a device is fixed.
struct Mount {
  std::size_t entity = 0;           ///< into Layout::entities and State::origins
  std::optional<std::size_t> link;  ///< into State::links; none: the entity's origin frame
  math::Pose pose;                  ///< X_AD of the device in that frame
};

/// A radio of a robot whose controller enables radios.
struct RadioLayout {
  std::string id;
  Mount mount;
  double range = 0;        ///< of sending [m]; who is strictly closer hears
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
  std::optional<double> angle;  ///< about +z from +x, (-pi, pi] [rad]; of foot-bots' own sensor,
                                ///< which tells it with each reading
};

/// A range-and-bearing device of any entity: at most one each.
struct RangeAndBearingLayout {
  Mount mount;       ///< bearings are relative to its frame
  double range = 0;  ///< of sending [m]; who is strictly closer receives
  std::size_t medium = 0;
  Range data;             ///< its bytes in State::, Commands::range_and_bearing_data
  bool sends = false;     ///< its controller has the actuator; without, it sends zeros
  bool receives = false;  ///< its controller has the sensor
};

/// A battery of a robot whose controller has the sensor.
struct BatteryLayout {
  std::size_t entity = 0;
};

/// What a camera looks for, and on which medium.
struct DetectorLayout {
  std::size_t medium = 0;   ///< into scene::Scene::media
  bool shows_rays = false;  ///< its lines of sight go to State::rays
};

/// A pinhole camera of a robot whose controller has the sensor. A point at (X, Y, Z) in the
/// camera's frame, +z forward, +x right, +y down, is seen at u = fx X/Z + cx, v = fy Y/Z + cy:
/// real pixels from the image's top left corner, u to the right, v down.
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

/// An entity with a controller. Each range is empty unless the controller enables the device.
struct RobotLayout {
  std::string id;
  std::size_t entity = 0;      ///< into Layout::entities
  std::size_t controller = 0;  ///< into scene::Scene::controllers
  std::vector<std::pair<std::string, std::string>> params;
  Range joint_sensors;      ///< into Layout::joint_sensors and Observations::joint_readings
  Range joint_actuators;    ///< into Layout::joint_actuators and Commands::joint_targets
  Range radios;             ///< into Layout::radios: actuator, sensor or both are enabled
  Range leds;               ///< into Layout::leds and Commands::led_colors
  Range directional_leds;   ///< into Layout::directional_leds and Commands::directional_led_colors
  Range tags;               ///< into Layout::tags and Commands::tag_payloads
  Range magnets;            ///< into Layout::magnets and Commands::magnet_currents
  Range proximity;          ///< into Layout::proximity and Observations::proximity
  Range range_and_bearing;  ///< 0 or 1 of Layout::range_and_bearing: actuator, sensor or both
  Range positioning;        ///< 0 or 1 of Observations::positioning
  Range batteries;          ///< 0 or 1 of Layout::batteries and Observations::batteries
  Range cameras;            ///< into Layout::cameras
  Range wheels;             ///< 0 or 1 of Layout::wheels, Commands::, Observations::wheels
  Range turrets;            ///< 0 or 1 of Layout::turrets, Commands::, Observations::turrets
};

struct Layout {
  std::vector<EntityLayout> entities;
  std::vector<LinkLayout> links;
  std::vector<RobotLayout> robots;
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
};

}  // namespace ziggurat::world
