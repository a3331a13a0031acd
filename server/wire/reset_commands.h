#pragma once
// Commands of a robot that left, or that a new session takes.

#include <cstddef>

#include "wire/roster.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// Joint targets, currents of magnets, speeds of wheels and turrets and data of range and bearing
/// become 0. LEDs, tags and a turret's mode stay as they are.
/// @param robot  into the layout's robots
void reset_commands(const world::Layout& layout, std::size_t robot, world::Commands& commands);

/// Takes back the radio messages that the robots of a session have sent at this tick.
void forget_radio_messages(const Roster& roster, world::RadioMessages& messages);

}  // namespace ziggurat::wire
