#pragma once
// Command -> world::Commands, and Leave. A message is checked whole before anything of it has
// effect. The part of radios is in command_radios.cpp, that of channels in devices.cpp.

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

}  // namespace ziggurat::wire
