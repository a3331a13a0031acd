// SPDX-License-Identifier: MIT
#pragma once
// Devices on the wire: their descriptions in Welcome, and the channels of Observation and Command.
// The messages of radios, range and bearing and cameras have files of their own.

#include <cstddef>
#include <optional>
#include <span>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/commands.h"
#include "world/layout.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// @param robot  into the layout's robots
void describe(const Run& run, std::size_t robot, v1::RobotDescription& description);
/// Whether a Welcome has place for the descriptions of these robots (docs/protocol.md, H9).
bool fit_into_welcome(const Run& run, std::span<const std::size_t> robots);

/// Writes the readings of a session's robots.
void add_channels(const Roster& roster, const world::Observations& from, v1::Observation& to);

/// Writes all that a session's robots want, without their radio messages.
void add_channels(const Roster& roster, const world::Commands& from, v1::Command& to);
/// Bytes of the tag payloads among that.
std::size_t payload_bytes(const Roster& roster, const world::Commands& from);

/// Lengths and values, if the command's robots are right.
std::optional<Fault> check_channels(const v1::Command& command, const Roster& roster,
                                    const world::Layout& layout);

/// Writes checked values. Those of robots that left are skipped.
void apply_channels(const v1::Command& command, const Roster& roster, world::Commands& commands);

}  // namespace ziggurat::wire
