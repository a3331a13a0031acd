// SPDX-License-Identifier: MIT
#pragma once
// Command -> world::Commands, Leave, and the commands of robots that left. A message is checked
// whole before anything of it has effect. The part of radios is in command_radios.cpp, that of
// channels in devices.cpp, that of markers in command_markers.cpp.

#include <cstddef>
#include <optional>
#include <vector>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/commands.h"
#include "world/layout.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Checks a command of this session; its tick is left to the caller.
std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout);

/// The same for a leave of this session.
std::optional<Fault> check(const v1::Leave& leave, const Roster& roster,
                           const world::Layout& layout);

/// The same for lines of a log.
std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster);

/// Writes a checked command's values. Those of robots that left are skipped.
void apply(const v1::Command& command, const Roster& roster, world::Commands& commands);

/// Appends checked lines.
void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines);

/// Checks the radio messages of a command whose robots are right.
std::optional<Fault> check_radio_messages(const v1::Command& command, const Roster& roster,
                                          const world::Layout& layout);

/// Appends checked messages. Those of robots that are gone are skipped.
void apply_radio_messages(const v1::Command& command, const Roster& roster,
                          world::RadioMessages& messages);

/// The same for markers.
std::optional<Fault> check_markers(const v1::Command& command, const Roster& roster,
                                   const world::Layout& layout);
void apply_markers(const v1::Command& command, const Roster& roster,
                   std::vector<world::Marker>& markers);

/// @param robot  its number in the message
void write(const world::Marker& marker, std::size_t robot, v1::Marker& to);

/// Joint targets, currents of magnets, speeds of wheels and turrets and data of range and bearing
/// become 0. LEDs, tags and a turret's mode stay as they are.
/// @param robot  into the layout's robots
void reset_commands(const world::Layout& layout, std::size_t robot, world::Commands& commands);

/// Takes back the radio messages that the robots of a session have sent at this tick.
void forget_radio_messages(const Roster& roster, world::RadioMessages& messages);
/// The same for markers.
void forget_markers(const Roster& roster, std::vector<world::Marker>& markers);

/// Checks the metrics of a session.
std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics,
                           const Roster& roster);

/// The same for their names and values only.
std::optional<Fault> check_names_and_values(
    const google::protobuf::RepeatedPtrField<v1::Metric>& metrics);

/// Appends checked metrics. Those of robots that were taken over are skipped.
void append(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics, const Roster& roster,
            std::vector<Metric>& to);

}  // namespace ziggurat::wire
