// SPDX-License-Identifier: MIT
#pragma once
// Extent of a decoded message, found before it is decoded. Bytes from anyone may be few and take a
// thousand times as much memory.

#include <google/protobuf/descriptor.h>

#include <cstddef>
#include <string_view>

namespace ziggurat::v1 {

/// So many bytes of text, or numbers of a list that have no fixed size, count as one field.
inline constexpr std::size_t bytes_per_field = 16;

/// Number of fields of a message and of messages in it; arrays of numbers of a fixed size count as
/// one.
/// @param type  of the message that the bytes are
/// @param most  it stops counting beyond that
std::size_t count_fields(std::string_view bytes, const google::protobuf::Descriptor& type,
                         std::size_t most);

/// An upper bound of the memory that the decoded message takes while it is decoded, without the
/// bytes themselves [bytes]. Beyond `most` if it has groups, which no message of ours has.
/// @param type  of the message that the bytes are; a generated one
/// @param most  it stops counting beyond that [bytes]
std::size_t decoded_size(std::string_view bytes, const google::protobuf::Descriptor& type,
                         std::size_t most);

}  // namespace ziggurat::v1
