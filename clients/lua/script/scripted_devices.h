#pragma once
// Devices as a script sees them: plain values. What is sensed is written by whoever runs the
// script before a call; what is commanded is taken after it, where a flag says that it is fresh:
// set since somebody put the flag to false.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

}  // namespace ziggurat::lua
