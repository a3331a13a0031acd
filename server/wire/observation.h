#pragma once
// world::Observations -> Observation.

#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Writes what a session's robots sense; `to` is clear.
void fill(const Roster& roster, const world::Observations& from, v1::Observation& to);

}  // namespace ziggurat::wire
