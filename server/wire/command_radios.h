#pragma once
// The radio messages of Command.

#include <optional>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// What is wrong with the messages, if the command's robots are right.
std::optional<Fault> check_radio_messages(const v1::Command& command, const Roster& roster,
                                          const world::Layout& layout);

/// Appends checked messages. Those of robots that are gone are skipped.
void apply_radio_messages(const v1::Command& command, const Roster& roster,
                          world::RadioMessages& messages);

}  // namespace ziggurat::wire
