#pragma once
// What becomes of the commands of a robot that left.

#include <cstddef>

#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::wire {

/// Joint targets, currents of magnets, speeds of wheels and turrets and data of range and bearing
/// become 0. LEDs, tags and a turret's mode stay as they are.
/// @param robot  into the layout's robots
void zero(const world::Layout& layout, std::size_t robot, world::Commands& commands);

}  // namespace ziggurat::wire
