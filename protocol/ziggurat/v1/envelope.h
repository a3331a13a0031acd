// SPDX-License-Identifier: MIT
#pragma once
// Helpers that both ends of the wire need beside the generated messages.

#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::v1 {

/// The content of field `number` if the bytes hold that length-delimited field and nothing else,
/// as nearly every ClientMessage and ServerMessage does. Parsing it into a long-lived message
/// keeps that message's arrays from tick to tick, which parsing the `oneof` around it would not.
/// @param number  1 … 15
std::optional<std::string_view> sole_field(std::string_view bytes, int number);

/// The text with every byte that is not part of valid UTF-8 replaced by U+FFFD: protobuf refuses
/// whole messages for one such byte.
std::string valid_utf8(std::string_view text);

}  // namespace ziggurat::v1
