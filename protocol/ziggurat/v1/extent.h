#pragma once
// What decoding bytes would make, found out before they are decoded: bytes of anyone may be small and take a thousand
// times as much memory.

#include <google/protobuf/descriptor.h>

#include <cstddef>
#include <string_view>

namespace ziggurat::v1 {

/// So many bytes of text, or numbers of a list that have no fixed size, count as one field.
inline constexpr std::size_t bytes_per_field = 16;

/// What a server counts, at most, of an Observation or a WorldState for the memory that it takes when it is decoded
/// (docs/protocol.md, D5) [bytes].
inline constexpr std::size_t most_counted = std::size_t{2} << 30;
/// What a client takes as decoded_size() of one: there is place for what the server does not count, some twenty million
/// numbers [bytes].
inline constexpr std::size_t most_decoded = most_counted + (std::size_t{512} << 20);

/// Of all `WorldLayout`s since one that began anew, as decoded_size() says it: a server tells no more, and a client takes no more (R4)
/// [bytes].
inline constexpr std::size_t most_laid_out = std::size_t{1} << 30;

/// Of all else that a server sends, and sends once, clients decode no more (H9): bytes, fields as count_fields() says it, and robots of a
/// session.
inline constexpr std::size_t longest_sent_once = std::size_t{64} << 20, most_fields_sent_once = std::size_t{1} << 21,
                             most_robots = std::size_t{1} << 18;

/// What each part counts, beside its content: no less than decoded_size() says of it [bytes].
inline constexpr std::size_t counted_radio_message = 256, counted_packet = 256, counted_payload = 128, counted_color = 24,
                             counted_led = 96, counted_tag = 384;

/// How many fields a message has, those of messages in it included; arrays of numbers of a fixed size count as one.
/// @param type  of the message that the bytes are
/// @param most  it stops counting beyond that
std::size_t count_fields(std::string_view bytes, const google::protobuf::Descriptor& type, std::size_t most);

/// An upper bound of the memory that the decoded message takes while it is decoded, without the bytes themselves [bytes]. Beyond `most`
/// if it has groups, which no message of ours has.
/// @param type  of the message that the bytes are; a generated one
/// @param most  it stops counting beyond that [bytes]
std::size_t decoded_size(std::string_view bytes, const google::protobuf::Descriptor& type, std::size_t most);

}  // namespace ziggurat::v1
