#pragma once
// Whether a text is JSON that matches a message. protobuf's own parser also takes single quotes,
// names without quotes, trailing commas and a text where a list belongs.

#include <google/protobuf/descriptor.h>

#include <string>
#include <string_view>

namespace ziggurat::wire {

/// How deep objects and arrays may be nested, unknown fields included.
inline constexpr std::size_t deepest_json = 64;

/// What makes the text none of RFC 8259, or none of the canonical JSON of this type, as far as
/// protobuf does not find out; empty: nothing. Reads the text once, and keeps a few bytes per level
/// and the longest string.
std::string check_json(std::string_view text, const google::protobuf::Descriptor& type);

}  // namespace ziggurat::wire
