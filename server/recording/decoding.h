// SPDX-License-Identifier: MIT
#pragma once
// Decoder of all messages of recordings. A recording may come from anyone, and two bytes of a
// message can take a hundred times as much memory. So the memory is counted before it is taken.

#include <google/protobuf/message.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::recording {

/// The most that a message may have.
struct Bound {
  std::size_t bytes = 0;   ///< encoded
  std::size_t memory = 0;  ///< decoded [bytes], as v1::decoded_size() counts it
};

/// Bound of /world and /scene, which list all entities and devices: 20 000 foot-bots, or 600 000
/// boxes, have 128 MiB.
inline constexpr Bound bound_of_worlds{std::size_t{128} << 20, std::size_t{1} << 30};
/// Bound of /inputs and /state: exact states of 300 000 links have 32 MiB.
inline constexpr Bound bound_of_inputs{std::size_t{32} << 20, std::size_t{256} << 20};
/// Bound of all other messages, with the content of one tick, or a picture.
inline constexpr Bound bound_of_others{std::size_t{64} << 20, std::size_t{256} << 20};

Bound bound_of(const google::protobuf::Descriptor& type);

/// Replaces a message by what the bytes say. Memory of a large message before is given back first.
/// @returns what is wrong, as the end of a sentence that begins with the message; nothing: it is
/// decoded
std::optional<std::string> decode(std::string_view bytes, google::protobuf::Message& to);

}  // namespace ziggurat::recording
