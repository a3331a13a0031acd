// SPDX-License-Identifier: MIT
#pragma once
// Commands of robots. All arrays are in scene order and indexed by the lists of Layout. A field of
// Commands has its row in the table below it.

#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "world/channel.h"
#include "world/devices.h"
#include "world/floor.h"
#include "world/limits.h"
#include "world/marker.h"
#include "world/radio_messages.h"

namespace ziggurat::world {

/// Control mode of a turret.
enum class TurretMode : std::uint8_t { passive, position, speed };

struct WheelsCommand {
  double left = 0, right = 0;  ///< speed over the floor [m/s]
};

/// A force and a torque on a link.
struct Push {
  std::size_t link = 0;                          ///< into Layout::links
  math::Vector3 force = math::Vector3::Zero();   ///< at its centre of mass, in W [N]
  math::Vector3 torque = math::Vector3::Zero();  ///< in W [N m]
};

/// Commands of all robots. Values persist until changed; initially they are those of the scene.
/// Values of entities that no robot may set stay.
struct Commands {
  std::vector<double> joint_targets;  ///< [m], [rad], [m/s] or [rad/s] by the actuator's mode
  std::vector<Color> led_colors;      ///< at most 0xFFFFFF
  std::vector<Color> directional_led_colors;  ///< at most 0xFFFFFF
  std::vector<std::string> tag_payloads;      ///< any bytes, up to most_tag_payload_bytes
  std::vector<double> magnet_currents;        ///< finite, any sign
  std::vector<std::uint8_t> range_and_bearing_data;
  std::vector<WheelsCommand> wheels;
  std::vector<TurretMode> turret_modes;
  std::vector<double> turret_rotations;  ///< relative to the robot, in mode position [rad]
  std::vector<double> turret_speeds;     ///< relative to the robot, in mode speed [rad/s]
  /// Sent at the start of the next tick, which empties it: entries of one radio in the order of
  /// sending, those of different radios in any order. Only radios that send.
  RadioMessages radio_messages;
  /// By directors, during the next tick, which empties it; no robot sets any.
  std::vector<Push> pushes;
  /// By directors, before the next tick, which empties it; no robot sets any.
  std::vector<FloorPaint> floor_paints;
  /// Drawn by robots; the next tick moves them to State::markers. Those of one robot in the order
  /// of drawing.
  std::vector<Marker> markers;
  std::vector<double> device_commands;  ///< within the limits of Layout::device_commands
};

/// Forgets what controllers send once.
inline void forget_sent(Commands& commands) {
  commands.radio_messages.clear();
  commands.markers.clear();
}

/// The bytes that a robot broadcasts, if its controller has the actuator.
inline Range broadcast_bytes(const DeviceLists& lists, const DeviceRanges& robot) {
  if (robot.range_and_bearing.count == 0) return {};
  const RangeAndBearingLayout& device = lists.range_and_bearing[robot.range_and_bearing.begin];
  return {device.data.begin, device.sends ? device.data.count : 0};
}

// clang-format off
inline constexpr Rule<double> finite{
    [](const double& value) { return std::isfinite(value); }, "finite"};
inline constexpr Rule<WheelsCommand> finite_wheels{
    [](const WheelsCommand& v) { return std::isfinite(v.left) && std::isfinite(v.right); }, "finite"};
inline constexpr Rule<Color> color{
    [](const Color& value) { return value <= 0xFFFFFF; }, "0xRRGGBB"};
inline constexpr Rule<std::string> payload{
    [](const std::string& value) { return value.size() <= most_tag_payload_bytes; },
    "at most 65536 bytes", true};
static_assert(most_tag_payload_bytes == 65536);
inline constexpr Rule<TurretMode> turret_mode{
    [](const TurretMode& value) { return value <= TurretMode::speed; },
    "TURRET_PASSIVE, TURRET_POSITION or TURRET_SPEED"};

inline constexpr DevicesOf driven_wheels =
    one_if<&Ranges::wheels, &Lists::wheels, &WheelsLayout::drives>;
inline constexpr DevicesOf driven_turret =
    one_if<&Ranges::turrets, &Lists::turrets, &TurretLayout::drives>;

inline constexpr std::tuple commanded{
    Commanded<double>{&Commands::joint_targets, "joint_targets", "joint_targets",
        "target of joint", "joint actuators",
        all<&Ranges::joint_actuators>, id<&Lists::joint_actuators>, finite, Released::zeroed},
    Commanded<Color>{&Commands::led_colors, "led_colors", "led_colors",
        "color of LED", "LEDs with an actuator",
        all<&Ranges::leds>, id<&Lists::leds>, color, Released::kept},
    Commanded<Color>{&Commands::directional_led_colors, "directional_led_colors",
        "directional_led_colors", "color of directional LED", "directional LEDs with an actuator",
        all<&Ranges::directional_leds>, id<&Lists::directional_leds>, color, Released::kept},
    Commanded<std::string>{&Commands::tag_payloads, "tag_payloads", "tag_payloads",
        "payload of tag", "tags with an actuator",
        all<&Ranges::tags>, id<&Lists::tags>, payload, Released::kept},
    Commanded<double>{&Commands::magnet_currents, "magnet_currents", "magnet_currents",
        "current of magnet", "magnets with an actuator",
        all<&Ranges::magnets>, id<&Lists::magnets>, finite, Released::zeroed},
    Commanded<std::uint8_t>{&Commands::range_and_bearing_data, "range_and_bearing_data",
        "range_and_bearing_data", "byte", "bytes of range-and-bearing data",
        broadcast_bytes, nullptr, {nullptr, ""}, Released::zeroed},
    Commanded<WheelsCommand>{&Commands::wheels, "wheel_velocities", "wheels",
        "speed of a wheel", "pairs of wheels with an actuator",
        driven_wheels, nullptr, finite_wheels, Released::zeroed},
    Commanded<TurretMode>{&Commands::turret_modes, "turret_modes", "turret.mode",
        "turret mode", "turrets with an actuator",
        driven_turret, nullptr, turret_mode, Released::kept},
    Commanded<double>{&Commands::turret_rotations, "turret_rotations", "turret.rotation",
        "turret rotation", "turrets with an actuator",
        driven_turret, nullptr, finite, Released::kept},
    Commanded<double>{&Commands::turret_speeds, "turret_speeds", "turret.speed",
        "turret speed", "turrets with an actuator",
        driven_turret, nullptr, finite, Released::zeroed},
    ByHand{&Commands::radio_messages, Hashed::no},
    ByHand{&Commands::pushes, Hashed::no},
    ByHand{&Commands::floor_paints, Hashed::no},
    ByHand{&Commands::markers, Hashed::no},
    Commanded<double>{&Commands::device_commands, "device_commands", nullptr,
        "command of a device", "commands of devices",
        all<&Ranges::device_commands>, nullptr, finite, Released::described},
};
// clang-format on

}  // namespace ziggurat::world
