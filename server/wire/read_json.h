#pragma once
// protobuf's canonical JSON, read as strictly as RFC 8259 has it. protobuf's own parser also takes
// single quotes, names without quotes, trailing commas and a text where a list belongs, and it may
// end the process if memory runs out.

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

namespace ziggurat::wire {

/// How deep objects and arrays may be nested, unknown fields included.
inline constexpr std::size_t deepest_json = 64;

/// Adds what the text says to an empty message. Unknown fields are ignored, and names of unknown
/// values of enumerations. Reads the text once; beside the message it keeps a few bytes per level
/// and the longest string.
/// @return what makes the text none of RFC 8259, or none of the canonical JSON of this message;
///         empty: nothing. Otherwise the message holds a part.
/// @throws std::bad_alloc
std::string read_json(std::string_view text, google::protobuf::Message& message);

}  // namespace ziggurat::wire
