#pragma once
// world::Observations -> Observation. The cameras' part is in observation_cameras.cpp.

#include <cstddef>
#include <span>
#include <string>

#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// What the radios and range-and-bearing devices of a session's robots received.
struct Heard {
  std::size_t sent = 0;  ///< content of radio messages [bytes]
  std::size_t rest = 0;  ///< least memory of all else; messages without content take it, too [bytes]
};
Heard heard_by(const Roster& roster, const world::Observations& from);

/// Bytes of payloads that cameras of the session's robots read.
std::size_t payload_bytes(const Roster& roster, const world::Observations& from,
                          std::span<const std::string> tag_payloads);

/// Bytes of pictures that they took.
std::size_t image_bytes(const Roster& roster, const world::Observations& from);

/// Writes what they see. A camera without a picture yet sends an empty one.
void add_cameras(const Roster& roster, const world::Observations& from,
                 std::span<const std::string> tag_payloads, v1::Observation& to);

/// Writes what a session's robots sense; `to` is clear.
/// @param tag_payloads  of the same tick, for each of Layout::tags
void fill(const Roster& roster, const world::Observations& from,
          std::span<const std::string> tag_payloads, v1::Observation& to);

}  // namespace ziggurat::wire
