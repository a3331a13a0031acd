// SPDX-License-Identifier: MIT
#pragma once
// Robots of one session, and the position of each device value: in the session's packed arrays on
// one side, in the world's flat arrays on the other.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "wire/messages.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// Values of one kind of device over all robots of a session, packed robot by robot.
struct Packing {
  /// Values that are neighbours on both sides.
  struct Stretch {
    std::size_t packed = 0;  ///< start in the session's array
    std::size_t flat = 0;    ///< start in the world's array
    std::size_t count = 0;
  };
  std::vector<Stretch> robots;     ///< one per robot of the session
  std::vector<Stretch> stretches;  ///< the same values in as few pieces as possible
  std::size_t count = 0;           ///< of all values

  void append(const world::Range& flat);
  /// The robot, as a position in the session, that the value at `packed` < count belongs to.
  std::size_t owner(std::size_t packed) const;
};

/// Positions are fixed for the life of a session; robots may leave.
struct Roster {
  std::vector<std::size_t> robots;  ///< into Layout::robots, in scene order
  std::vector<bool> gone;           ///< per robot: left the barrier for good, or taken over
  std::vector<bool> taken;          ///< per robot: another session has taken it over
  std::size_t gone_count = 0;
  // By the row of a channel in the tables of world/; empty for fields handled by hand.
  std::array<Packing, std::tuple_size_v<decltype(world::sensed)>> sensed;
  std::array<Packing, std::tuple_size_v<decltype(world::commanded)>> commanded;
  Packing radios;
  Packing range_and_bearing;  ///< devices: 0 or 1 of each robot
  Packing device_lists;       ///< described devices with rows: into Observations::device_rows

  // Cameras that have the detector, or take pictures: into Layout::cameras, ascending.
  std::vector<std::size_t> led_cameras;
  std::vector<std::size_t> directional_led_cameras;
  std::vector<std::size_t> tag_cameras;
  std::vector<std::size_t> image_cameras;

  bool empty() const { return gone_count == robots.size(); }  ///< all are gone
  void leave(std::size_t position);                           ///< no effect if gone already
  void hand_over(std::size_t position);                       ///< likewise
};

/// @param robots  into Layout::robots, ascending
Roster make_roster(const world::Layout& layout, std::span<const std::size_t> robots);

/// UNKNOWN_ROBOT if the session has no robot at a position that a message names.
/// @param field  the message's field that names it
std::optional<Fault> check_position(std::size_t position, const Roster& roster, std::string field);

}  // namespace ziggurat::wire
