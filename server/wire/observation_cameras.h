#pragma once
// The parts of Observation that cameras fill.

#include <cstddef>
#include <span>
#include <string>

#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Bytes of payloads that cameras of the session's robots read.
std::size_t payload_bytes(const Roster& roster, const world::Observations& from,
                          std::span<const std::string> tag_payloads);

/// Bytes of pictures that they took.
std::size_t image_bytes(const Roster& roster, const world::Observations& from);

/// Writes what they see. A camera whose picture is not there sends an empty one.
void add_cameras(const Roster& roster, const world::Observations& from,
                 std::span<const std::string> tag_payloads, v1::Observation& to);

}  // namespace ziggurat::wire
