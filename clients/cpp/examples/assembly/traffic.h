// SPDX-License-Identifier: MIT
#pragma once
// Traffic rules that keep robots clear of each other. Each robot tells the others within 2 m by
// range and bearing what it does. The three bytes are those of the Lua script: flags, claim, a
// random number. No robot knows another's plan.

#include <ziggurat/ziggurat.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "geometry.h"
#include "path.h"
#include "random.h"

namespace assembly {

/// Another robot in range.
struct Neighbour {
  double forward = 0, left = 0, range = 0;  ///< in this robot's frame [m]
  bool working = false, asking = false, holding = false, stopped = false;
  std::uint8_t row = 0;
  std::uint8_t claim = 0;
};

struct Traffic {
  std::vector<Neighbour> neighbours;
  bool working = false;    ///< it picks up or places a block: the others keep out of its way
  bool asking = false;     ///< it is lined up with a side of the structure and wants to go there
  bool holding = false;    ///< it works there
  bool stopped = false;    ///< another robot is in its way
  std::uint8_t row = 0;    ///< by which it wants to attach a block; 0 if it does not know
  std::uint8_t claim = 1;  ///< of two that ask, the one with the greater claim may
  int asked = 0;           ///< ticks since it asked
  /// Ticks for which the same bytes have come, by the bytes: a robot whose controller has died goes
  /// on sending its last ones.
  std::map<std::vector<std::uint8_t>, int> unchanged;
};

/// Reads what the others say; call it first in every step.
void sense(Traffic& traffic, const ziggurat::RangeAndBearing& device);
/// Tells the others; call it last in every step.
void tell(const Traffic& traffic, ziggurat::RangeAndBearing& device, Random& random);

using Judgement = std::function<bool(const Neighbour&)>;
/// Asks for a corridor to the structure; call it in every step. True when this robot may go: for
/// half a second no rival has held or asked with a greater claim.
/// @param is_in_the_way  whether another robot is in the corridor
/// @param is_rival       whether it might get into the way from where it is
bool may_enter(Traffic& traffic, Random& random, const Judgement& is_in_the_way,
               const Judgement& is_rival);
void leave_structure(Traffic& traffic);

/// Whether a robot is in the way of a motion with this sign (1 forward, -1 backward).
/// @param reach  nearer than this to the robot's front or back [m]
bool is_blocked(const Traffic& traffic, double direction, double reach = 0.245);
/// Null if there is none.
const Neighbour* nearest(const Traffic& traffic);
/// Position of another robot, in the frame of the pose.
Point place_of(const Neighbour& other, const Pose& pose);
/// Adds the others to a list, in the frame of the pose. Those that are far away and not at work
/// will be somewhere else when this robot comes there.
void add_obstacles(const Traffic& traffic, const Pose& pose, std::vector<Obstacle>& list);

}  // namespace assembly
