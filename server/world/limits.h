// SPDX-License-Identifier: MIT
#pragma once
// Limits of what a robot may send, or a director do, in one tick. More is an error of the client.

#include <cstddef>

namespace ziggurat::world {

inline constexpr std::size_t most_radio_message_bytes = std::size_t{1} << 20;
inline constexpr std::size_t most_radio_bytes_per_robot = std::size_t{16} << 20;  ///< and tick
/// An empty message costs no byte: their number is bounded too, per robot and tick.
inline constexpr std::size_t most_radio_messages_per_robot = std::size_t{1} << 16;
/// Messages that all radios receive at a tick: a message that many hear takes memory for each of
/// them.
inline constexpr std::size_t most_received_messages = std::size_t{1} << 24;
/// Pairs of range-and-bearing devices that reach each other at a tick.
inline constexpr std::size_t most_pairs_in_range = std::size_t{1} << 24;
/// Lines of sight that all cameras test at a tick: one for an LED in view, up to four for a tag;
/// and, counted apart, those of blob cameras and light sensors.
inline constexpr std::size_t most_lines_of_sight = std::size_t{1} << 24;
inline constexpr std::size_t most_tag_payload_bytes = std::size_t{64} << 10;
/// Limit of each component of a director's push, in newtons and newton metres.
inline constexpr double largest_push = 1e6;

}  // namespace ziggurat::world
