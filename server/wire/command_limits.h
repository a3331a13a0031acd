#pragma once
// Size limit of a Command for its session: a larger one only costs time of the tick.

#include <cstddef>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/layout.h"

namespace ziggurat::wire {

struct CommandLimits {
  std::size_t bytes = 0;   ///< of the message
  std::size_t fields = 0;  ///< as count_fields() and count_json_values() count them
};

/// For log lines, metrics, a value of each device of the robots and what they send by radio. Those
/// of a few robots take about a millisecond to decode; JSON takes longer for each byte and has less
/// of what is free.
CommandLimits command_limits(const Roster& roster, const world::Layout& layout, Encoding encoding);

}  // namespace ziggurat::wire
