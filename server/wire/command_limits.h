// SPDX-License-Identifier: MIT
#pragma once
// Cost of decoding a message, estimated before, and the size limit of a Command for its session.

#include <cstddef>
#include <string_view>

#include "wire/messages.h"
#include "wire/roster.h"
#include "world/layout.h"
#include "ziggurat/v1/extent.h"

namespace ziggurat::wire {

struct CommandLimits {
  std::size_t bytes = 0;   ///< of the message
  std::size_t fields = 0;  ///< as count_fields() and count_json_values() count them
};

/// For log lines, metrics, a value of each device of the robots and what they send by radio. Those
/// of a few robots take about a millisecond to decode; JSON takes longer for each byte and has less
/// of what is free.
CommandLimits command_limits(const Roster& roster, const world::Layout& layout, Encoding encoding);

/// Fields of a message, those of messages in it included; arrays count as one. A Command may have
/// fewer: see CommandLimits.
inline constexpr std::size_t most_fields = std::size_t{1} << 18;

using v1::bytes_per_field;

/// Number of fields of a ClientMessage in binary form, up to `most_fields`. Decoding takes up to
/// about 100 bytes of memory for each.
std::size_t count_fields(std::string_view bytes);

/// At least as many as a text of JSON has values: one for each comma and bracket that is in no
/// text.
std::size_t count_json_values(std::string_view text);

}  // namespace ziggurat::wire
