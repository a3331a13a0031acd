#pragma once
// How long a Command can be that its session needs: a longer one only costs time.

#include <cstddef>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// For log lines and all that no device needs [bytes].
inline constexpr std::size_t command_allowance = std::size_t{4} << 20;
/// JSON takes 17 times as long to read as binary [bytes].
inline constexpr std::size_t longest_json_command = std::size_t{24} << 20;

/// For one value of each device of the robots, and as many radio messages as they may send [bytes].
std::size_t longest_command(const Roster& roster, const world::Layout& layout, Encoding encoding);

}  // namespace ziggurat::wire
