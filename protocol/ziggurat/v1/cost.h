#pragma once
// What decoding a message would cost, found out before it is decoded.

#include <cstddef>
#include <string_view>

namespace google::protobuf {
class Descriptor;
}

namespace ziggurat::v1 {

/// So many bytes of text, or numbers of a list that have no fixed size, count as one field.
inline constexpr std::size_t bytes_per_field = 16;

/// How many fields a message in binary form has, those of messages in it included; arrays count as one.
/// @param message  the type that the bytes are of
/// @param most  it stops counting beyond that
std::size_t count_fields(std::string_view bytes, const google::protobuf::Descriptor& message, std::size_t most);

}  // namespace ziggurat::v1
