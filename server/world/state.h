#pragma once
// What is true at one tick, what robots are told of it, and what they answered.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/hash.h"
#include "math/pose.h"
#include "world/layout.h"

namespace ziggurat::world {

struct LinkState {
  math::Pose pose;                                         ///< X_WL of the bottom-centre frame
  math::Vector3 velocity = math::Vector3::Zero();          ///< of the frame's origin, in W [m/s]
  math::Vector3 angular_velocity = math::Vector3::Zero();  ///< in W [rad/s]
};

/// A segment that a device tested, or a link between two devices; only of devices that ask for
/// it (`show_rays`).
struct Ray {
  enum class Kind : std::uint8_t {
    proximity,          ///< from the sensor to the end of its range, or to what it met
    radio,              ///< from the sender to the receiver of at least one message
    range_and_bearing,  ///< from the sender to the receiver of a packet, or to what was in between
    camera,             ///< from the camera to what it looked for, or to what was in between
  };
  Kind kind = Kind::proximity;
  std::size_t robot = 0;     ///< into Layout::robots: whose device it is; the receiver's
  math::Vector3 start, end;  ///< in W [m]
  bool hit = false;          ///< not radio: an entity was met at `end`
};

/// What a camera can see, from its near to its far plane; of cameras that ask for it.
struct Frustum {
  std::size_t camera = 0;                ///< into Layout::cameras
  std::array<math::Vector3, 8> corners;  ///< in W [m]: of the near plane, then of the far one, each
                                         ///< top left, top right, bottom right, bottom left
};

struct State {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;         ///< simulated: round(tick * 1e9 / ticks_per_second)
  std::vector<math::Pose> origins;  ///< X_WE per entity
  std::vector<LinkState> links;     ///< of all entities, in scene order
  std::vector<bool> absent;         ///< per entity: it was removed, its places hold what was there
                                    ///< last; may be shorter: the rest is present

  // What others can perceive; each as long as its list in Layout.
  std::vector<Color> led_colors;
  std::vector<Color> directional_led_colors;
  std::vector<std::string> tag_payloads;             ///< any bytes
  std::vector<math::Vector3> magnet_fields;          ///< anchor frame, the dialect's unit
  std::vector<std::uint8_t> range_and_bearing_data;  ///< as RangeAndBearingLayout::data says

  std::vector<Ray> rays;        ///< not part of the hash
  std::vector<Frustum> frusta;  ///< not part of the hash

  bool is_absent(std::size_t entity) const { return entity < absent.size() && absent[entity]; }
};

/// Messages of radios. Their bytes stand in one buffer, and may be shared by several messages.
struct RadioMessages {
  struct Entry {
    std::size_t radio = 0;  ///< into Layout::radios
    std::size_t begin = 0;  ///< into `bytes`
    std::size_t size = 0;   ///< [bytes], may be 0
  };
  std::vector<Entry> entries;
  std::vector<std::uint8_t> bytes;

  std::span<const std::uint8_t> payload(const Entry& entry) const {
    return std::span(bytes).subspan(entry.begin, entry.size);
  }
  void add(std::size_t radio, std::span<const std::uint8_t> payload) {
    entries.push_back({radio, bytes.size(), payload.size()});
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  }
  void clear() {  ///< keeps the memory
    entries.clear();
    bytes.clear();
  }
};

/// A packet that a range-and-bearing device received.
struct RangeAndBearingPacket {
  std::size_t receiver = 0;       ///< into Layout::range_and_bearing
  double range = 0;               ///< distance between the two devices, with the sensor's noise [m]
  double horizontal_bearing = 0;  ///< about +z of the receiver's frame from +x, (-pi, pi] [rad]
  double vertical_bearing = 0;    ///< above its xy plane, [-pi/2, pi/2] [rad]
  Range data;                     ///< into Observations::range_and_bearing_data; the receiver's
                                  ///< own number of bytes
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

/// A picture that a camera took: rows from top to bottom, pixels from left to right, red, green
/// and blue of one byte each. Empty at tick 0.
struct Image {
  std::size_t camera = 0;  ///< into Layout::cameras
  std::vector<std::uint8_t> rgb;
};

/// What all robots sense at one tick, packed in scene order.
struct Observations {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::vector<double> joint_readings;  ///< [m], [rad], [m/s] or [rad/s] as the sensor's mode says
  RadioMessages radio_messages;   ///< received since the last tick: entries ascend by receiving
                                  ///< radio; for each, by sending radio, then as sent
  std::vector<double> proximity;  ///< 0 (nothing) ... 1, or what the response says
  std::vector<RangeAndBearingPacket> range_and_bearing;  ///< ascending by receiver, then by sender
  std::vector<std::uint8_t> range_and_bearing_data;
  std::vector<math::Pose> positioning;  ///< X_WE, with the sensor's noise
  std::vector<BatteryReading> batteries;
  std::vector<LedReading> leds;              ///< ascending by camera, then in scene order
  std::vector<LedReading> directional_leds;  ///< likewise
  std::vector<TagReading> tags;              ///< likewise
  std::vector<WheelsReading> wheels;         ///< zeros where the controller has no sensor
  std::vector<double> turrets;               ///< about +z of the robot's origin, [-pi, pi] [rad]
  std::vector<Image> images;                 ///< of cameras that ask; not part of the hash
};

/// How a turret turns.
enum class TurretMode : std::uint8_t { passive, position, speed };

struct WheelsCommand {
  double left = 0, right = 0;  ///< speed over the floor [m/s]
};

struct TurretCommand {
  TurretMode mode = TurretMode::passive;
  double rotation = 0;  ///< relative to the robot, in mode position [rad]
  double speed = 0;     ///< relative to the robot, in mode speed [rad/s]
};

/// What all robots want, packed in scene order. Values persist until changed; what the scene says
/// is there before anything was commanded. Entries of entities that no robot may set stay.
struct Commands {
  std::vector<double> joint_targets;  ///< [m], [rad], [m/s] or [rad/s] as the actuator's mode says
  std::vector<Color> led_colors;      ///< at most 0xFFFFFF
  std::vector<Color> directional_led_colors;  ///< at most 0xFFFFFF
  std::vector<std::string> tag_payloads;      ///< any bytes, up to most_tag_payload_bytes
  std::vector<double> magnet_currents;        ///< finite, any sign
  std::vector<std::uint8_t> range_and_bearing_data;
  std::vector<WheelsCommand> wheels;
  std::vector<TurretCommand> turrets;
  /// To be sent at the start of the next tick, which empties it: entries of one radio in the order
  /// of sending, those of different radios in any. Only radios that send.
  RadioMessages radio_messages;
};

/// X_WD of a device.
math::Pose pose_of(const State& state, const Mount& mount);
/// Of a device's origin, in W [m].
math::Vector3 position_of(const State& state, const Mount& mount);

/// Hash of a state and what was sensed in it: equal for equal runs, whatever the transport.
std::uint64_t hash(const State& state, const Observations& observations);

}  // namespace ziggurat::world
