#pragma once
// Command -> world::Commands. Checked whole before anything of it has effect.

#include <optional>
#include <vector>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// What is wrong with a command of this session, if anything; the tick is the caller's to check.
std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout);

/// The same for lines of a log.
std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster);

/// Writes a checked command's values. Those of robots that are gone are skipped.
void apply(const v1::Command& command, const Roster& roster, world::Commands& commands);

/// Appends checked lines.
void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines);

}  // namespace ziggurat::wire
