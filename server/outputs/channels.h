#pragma once
// Channels as the named fields of recording.proto.

#include "outputs/reading.h"

namespace ziggurat::outputs {

/// Adds a robot's readings and shown values of fixed size.
void add_channels(const Moment& moment, const world::RobotLayout& robot, v1::RobotObservation& out);

/// Adds the values that it set.
void add_channels(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out);

}  // namespace ziggurat::outputs
