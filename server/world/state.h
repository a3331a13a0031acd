// SPDX-License-Identifier: MIT
#pragma once
// State of the world at one tick.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "math/pose.h"
#include "world/channel.h"
#include "world/floor.h"
#include "world/layout.h"
#include "world/marker.h"

namespace ziggurat::world {

struct LinkState {
  math::Pose pose;                                         ///< X_WL of the bottom-centre frame
  math::Vector3 velocity = math::Vector3::Zero();          ///< of the frame's origin, in W [m/s]
  math::Vector3 angular_velocity = math::Vector3::Zero();  ///< in W [rad/s]
};

/// A segment that a device tested, or a link between two devices; only of devices that ask for
/// them (`show_rays`).
struct Ray {
  enum class Kind : std::uint8_t {
    proximity,          ///< from the sensor to the end of its range, or to what it met
    radio,              ///< from the sender to the receiver of at least one message
    range_and_bearing,  ///< from the sender to the receiver of a packet, or to what was in between
    camera,             ///< from the camera to what it looked for, or to what was in between
    device,             ///< likewise, of a described device
  };
  Kind kind = Kind::proximity;
  /// Into Layout::robots: the one with the device; of a link, with the receiver.
  std::size_t robot = 0;
  math::Vector3 start = math::Vector3::Zero(), end = math::Vector3::Zero();  ///< in W [m]
  bool hit = false;  ///< not radio: an entity was met at `end`
};

/// Frustum of a camera from its near to its far plane, if the camera asks for it.
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

  // Visible state of entities; each array is as long as its list in Layout.
  std::vector<Color> led_colors;
  std::vector<Color> directional_led_colors;
  std::vector<std::string> tag_payloads;             ///< any bytes
  std::vector<math::Vector3> magnet_fields;          ///< anchor frame, the dialect's unit
  std::vector<std::uint8_t> range_and_bearing_data;  ///< at RangeAndBearingLayout::data

  std::vector<FloorPaint> floor;  ///< in the order of painting

  std::vector<Ray> rays;
  std::vector<Frustum> frusta;
  std::vector<Marker> markers;  ///< drawn with the last commands

  bool is_absent(std::size_t entity) const { return entity < absent.size() && absent[entity]; }
};

inline constexpr std::tuple state_fields{
    ByHand{&State::tick, Hashed::first},
    ByHand{&State::time_ns, Hashed::no},
    ByHand{&State::origins, Hashed::first},
    ByHand{&State::links, Hashed::first},
    ByHand{&State::absent, Hashed::first},
    Shown<Color>{&State::led_colors, "led_colors", &EntityLayout::leds},
    Shown<Color>{&State::directional_led_colors, "directional_led_colors",
                 &EntityLayout::directional_leds},
    Shown<std::string>{&State::tag_payloads, "tag_payloads", &EntityLayout::tags},
    Shown<math::Vector3>{&State::magnet_fields},
    Shown<std::uint8_t>{&State::range_and_bearing_data},
    ByHand{&State::floor, Hashed::second},
    ByHand{&State::rays, Hashed::no},
    ByHand{&State::frusta, Hashed::no},
    ByHand{&State::markers, Hashed::no},
};

/// X_WD of a device.
math::Pose pose_of(const State& state, const Mount& mount);
/// Position of a device's origin, in W [m].
math::Vector3 position_of(const State& state, const Mount& mount);

/// Hash of a state and what was sensed in it: equal for equal runs, whatever the transport.
std::uint64_t hash(const State& state, const Observations& observations);

/// Two links, or a link and the floor, that touch.
struct Contact {
  std::size_t link = 0;                          ///< into State::links
  std::optional<std::size_t> other;              ///< likewise; none: the floor
  math::Vector3 point = math::Vector3::Zero();   ///< the middle of the contact points, in W [m]
  math::Vector3 normal = math::Vector3::Zero();  ///< unit, from the other one to `link`, in W
  math::Vector3 force = math::Vector3::Zero();   ///< on `link`, normal and friction, in W [N]
};

}  // namespace ziggurat::world
