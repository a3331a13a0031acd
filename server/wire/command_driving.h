#pragma once
// The parts of Command that drive: wheels and turrets.

#include <optional>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Lengths and values, if the command's robots are right.
std::optional<Fault> check_driving(const v1::Command& command, const Roster& roster,
                                   const world::Layout& layout);

/// Writes checked values. Those of robots that are gone are skipped.
void apply_driving(const v1::Command& command, const Roster& roster, world::Commands& commands);

}  // namespace ziggurat::wire
