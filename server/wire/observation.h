// SPDX-License-Identifier: MIT
#pragma once
// world::Observations -> Observation. The cameras' part is in observation_cameras.cpp.

#include <cstddef>
#include <span>
#include <string>

#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Readings of a session at a tick, counted before there is a message with them (docs/protocol.md,
/// D5).
struct ReadingSize {
  std::size_t payloads = 0;  ///< content of radio messages and tags [bytes]
  std::size_t size = 0;      ///< of its share of the message, with these payloads [bytes]

  void add_payload(std::size_t bytes) {
    payloads += bytes;
    size += bytes;
  }
};

/// Readings of a session's robots from radios, tags and cameras.
/// @param tag_payloads  of the same tick, for each of Layout::tags
ReadingSize size_of_readings(const Roster& roster, const world::Observations& from,
                             std::span<const std::string> tag_payloads);

/// The part of it that cameras see.
void count_cameras(const Roster& roster, const world::Observations& from,
                   std::span<const std::string> tag_payloads, ReadingSize& to);

/// Writes what they see. A camera without a picture yet sends an empty one.
void add_cameras(const Roster& roster, const world::Observations& from,
                 std::span<const std::string> tag_payloads, v1::Observation& to);

/// Writes the readings of a session's robots; `to` is clear.
/// @param tag_payloads  of the same tick, for each of Layout::tags
void fill(const Roster& roster, const world::Observations& from,
          std::span<const std::string> tag_payloads, v1::Observation& to);

}  // namespace ziggurat::wire
