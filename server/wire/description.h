#pragma once
// What a client is told of a robot when it is welcomed.

#include <cstddef>

#include "wire/messages.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// @param robot  into the layout's robots
void describe(const Run& run, std::size_t robot, v1::RobotDescription& description);

}  // namespace ziggurat::wire
