#pragma once
// Cost of decoding a message of a peer, estimated before it is decoded.

#include <cstddef>
#include <string_view>

#include "ziggurat/v1/extent.h"

namespace ziggurat::wire {

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
