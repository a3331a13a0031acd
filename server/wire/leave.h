#pragma once
// The checks of Leave.

#include <optional>

#include "wire/messages.h"
#include "wire/roster.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// What is wrong with a leave of this session, if anything.
std::optional<Fault> check(const v1::Leave& leave, const Roster& roster,
                           const world::Layout& layout);

}  // namespace ziggurat::wire
