#pragma once
// Channels as the named fields of recording.proto.

#include "recording/reading.h"

namespace ziggurat::recording {

/// What a robot sensed and showed, of fixed size.
void add_channels(const Moment& moment, const world::RobotLayout& robot, v1::RobotObservation& out);

/// What it set.
void add_channels(const Moment& moment, const world::RobotLayout& robot, v1::RobotCommand& out);

}  // namespace ziggurat::recording
