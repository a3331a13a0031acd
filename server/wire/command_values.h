#pragma once
// The parts of Command that hold a value for each device of its robots, or nothing.

#include <optional>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Lengths and values, if the command's robots are right.
std::optional<Fault> check_values(const v1::Command& command, const Roster& roster,
                                  const world::Layout& layout);

/// Writes checked values. Those of robots that are gone are skipped.
void apply_values(const v1::Command& command, const Roster& roster, world::Commands& commands);

}  // namespace ziggurat::wire
