// SPDX-License-Identifier: MIT
#pragma once
// Parser of protobuf's canonical JSON, as strict as RFC 8259. protobuf's own parser also takes
// single quotes, names without quotes, trailing commas, and a text in place of a list. It may end
// the process if memory runs out.

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

namespace ziggurat::wire {

/// Greatest depth of nested objects and arrays, unknown fields included.
inline constexpr std::size_t deepest_json = 64;

/// Adds what the text says to an empty message. Unknown fields are ignored, and names of unknown
/// values of enumerations. Reads the text once; beside the message it keeps a few bytes per level
/// and the longest string.
/// @return what makes the text none of RFC 8259, or none of the canonical JSON of this message;
///         empty: nothing. Otherwise the message holds a part.
/// @throws std::bad_alloc
std::string read_json(std::string_view text, google::protobuf::Message& message);

}  // namespace ziggurat::wire
