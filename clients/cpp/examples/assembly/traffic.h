#pragma once
// How robots keep clear of each other. Each tells the others within 2 m by range and bearing what
// it does, in the same three bytes as the Lua script: flags, claim, a random number. None knows
// another's plan.

#include <ziggurat/ziggurat.h>

#include <cstdint>
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
  bool working = false, asking = false, holding = false;
  std::uint8_t claim = 0;
};

struct Traffic {
  std::vector<Neighbour> neighbours;
  bool working = false;    ///< it picks up or places a block: the others keep out of its way
  bool asking = false;     ///< it wants to work at the structure
  bool holding = false;    ///< it works there; others stay away from it
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

/// Asks for the structure; call it in every step. True when this robot may go there: for half a
/// second no robot has been there, and none with a greater claim has asked.
bool may_build(Traffic& traffic, Random& random);
void leave_structure(Traffic& traffic);

/// Whether a robot is in the way of a motion with this sign (1 forward, -1 backward).
bool is_blocked(const Traffic& traffic, double direction);
/// Null if there is none.
const Neighbour* nearest(const Traffic& traffic);
/// Adds the others to a list, in the frame of the pose.
void add_obstacles(const Traffic& traffic, const Pose& pose, std::vector<Obstacle>& list);

}  // namespace assembly
