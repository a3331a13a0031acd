#pragma once
// Devices as a script sees them: plain values. What is sensed is written by whoever runs the
// script before a call; what is commanded is taken after it, where a flag says that it is fresh:
// set since somebody put the flag to false.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat::lua {

/// A message of a radio, or the data of a range and bearing packet.
using Bytes = std::span<const std::uint8_t>;

/// How much a robot may send at one tick; more is a script's fault.
struct RadioLimits {
  std::size_t message = std::size_t{1} << 20;   ///< [bytes]
  std::size_t tick = std::size_t{16} << 20;     ///< all messages of the robot [bytes]
  std::size_t messages = std::size_t{1} << 16;  ///< of the robot
};

/// Messages sent at one tick, one behind the other. Keeps its memory from tick to tick.
struct Outgoing {
  std::vector<std::uint8_t> bytes;
  std::vector<std::size_t> ends;  ///< per message, into `bytes`

  void clear() {
    bytes.clear();
    ends.clear();
  }
};

/// robot.radios.<id>; a radio of the scene both receives and sends, if the controller has a
/// sensor and an actuator for radios.
struct Radio {
  std::string id;

  bool has_receiver = false;
  std::span<const Bytes> received;  ///< since the last tick; valid until the next

  bool has_transmitter = false;
  Outgoing sent;
};

/// A device among several that is set and not read: a colour, a payload, a current.
template <typename T>
struct Setting {
  T value{};
  bool is_fresh = false;

  void set(const T& to) {
    value = to;
    is_fresh = true;
  }
};

constexpr std::size_t max_tag_payload = std::size_t{64} << 10;  // [bytes]

struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Color&) const = default;
};

/// robot.magnets.<id>
struct Magnet {
  std::string id;
  Setting<double> current;  ///< in multiples of the magnet's active field
};

/// robot.positioning; the pose of the robot's origin in the world.
struct Positioning {
  std::array<double, 3> position{};               ///< x, y, z [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z
};

/// A packet that was heard, in robot.range_and_bearing[i].
struct Packet {
  double range = 0;               ///< to the sender [m]
  double horizontal_bearing = 0;  ///< to the sender, about +z from +x of the receiver [rad]
  double vertical_bearing = 0;    ///< to the sender, up from the receiver's x-y plane [rad]
  Bytes data;                     ///< valid until the next tick
};

/// robot.range_and_bearing
struct RangeAndBearing {
  bool has_receiver = false;
  std::vector<Packet> packets;  ///< heard at this tick

  bool has_transmitter = false;
  Setting<std::vector<std::uint8_t>> data;  ///< sent at every tick; its size is fixed
};

/// robot.battery
struct Battery {
  double available_charge = 0;  ///< of a full battery, in [0, 1]
  double time_left = 0;         ///< [s]
};

using Pixel = std::array<double, 2>;  ///< from the image's top left: right, down [px]

/// An LED in led_detector[i] or directional_led_detector[i] of a camera.
struct SeenLed {
  Color color;
  Pixel center{};
};

/// A tag in tag_detector[i] of a camera.
struct SeenTag {
  std::string_view payload;  ///< any bytes; valid until the next tick
  Pixel center{};
  std::array<Pixel, 4> corners{};  ///< in the tag's frame (-,-), (-,+), (+,+), (+,-)
};

/// robot.cameras.<id>
struct Camera {
  std::string id;
  std::string anchor;
  std::array<double, 3> position{};               ///< in the anchor's frame: x, y, z [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< camera to anchor, quaternion w, x, y, z
  double near = 0, far = 0;                       ///< along the optical axis [m]
  Pixel focal_length{};                           ///< fx, fy
  Pixel principal_point{};                        ///< cx, cy
  std::array<std::uint32_t, 2> resolution{};      ///< width, height [px]

  bool detects_leds = false;
  bool detects_directional_leds = false;
  bool detects_tags = false;
  bool takes_images = false;

  std::vector<SeenLed> leds;  ///< at this tick
  std::vector<SeenLed> directional_leds;
  std::vector<SeenTag> tags;
  Bytes image;  ///< red, green, blue; rows from the top; valid until the next tick
};

/// robot.wheels
struct Wheels {
  double axle_length = 0;  ///< [m]

  bool has_sensor = false;
  double velocity_left = 0, velocity_right = 0;  ///< [m/s]
  double distance_left = 0, distance_right = 0;  ///< in the last tick [m]

  bool has_actuator = false;
  Setting<std::array<double, 2>> velocities;  ///< left, right [m/s]
};

enum class TurretMode { passive, position, speed };

/// robot.turret
struct Turret {
  bool has_encoder = false;
  double rotation = 0;  ///< relative to the robot [rad]

  bool has_actuator = false;
  Setting<TurretMode> mode;
  Setting<double> target;  ///< relative to the robot [rad]
  Setting<double> speed;   ///< relative to the robot [rad/s]
};

}  // namespace ziggurat::lua
