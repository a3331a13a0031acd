#pragma once
// Extent of a decoded message, found before it is decoded. Bytes from anyone may be few and take a
// thousand times as much memory.

#include <google/protobuf/descriptor.h>

#include <cstddef>
#include <string_view>

namespace ziggurat::v1 {

/// So many bytes of text, or numbers of a list that have no fixed size, count as one field.
inline constexpr std::size_t bytes_per_field = 16;

/// Limit of a server for the memory that decoding an Observation or a WorldState takes
/// (docs/protocol.md, D5) [bytes].
inline constexpr std::size_t most_counted = std::size_t{2} << 30;

/// Limit of a server for decoded_size() of all `WorldLayout`s since one that began anew (R4)
/// [bytes].
inline constexpr std::size_t most_laid_out = std::size_t{1} << 30;

/// Limits of a server for all its other messages, which are sent once (H9): bytes, fields
/// as in count_fields(), and robots of a session.
inline constexpr std::size_t longest_sent_once = std::size_t{64} << 20,
                             most_fields_sent_once = std::size_t{1} << 21,
                             most_robots = std::size_t{1} << 18;

/// Memory that each part counts beside its content, at least that of decoded_size() [bytes].
inline constexpr std::size_t counted_radio_message = 256, counted_packet = 256,
                             counted_payload = 128, counted_color = 24, counted_led = 96,
                             counted_tag = 384;

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
