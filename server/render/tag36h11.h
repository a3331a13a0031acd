// SPDX-License-Identifier: MIT
#pragma once
// The patterns of AprilTag's family 36h11.
//
// A tag has 10 x 10 modules: a white margin of one, a black border of one, and 6 x 6 that say which
// it is. The scene's side_length is that of the black border's outer edge: 8 modules.

#include <cstddef>
#include <cstdint>
#include <span>

namespace ziggurat::render {

constexpr std::size_t tag36h11_count = 587;

/// By id. Bit 35 is the module at the top left, then row by row; 1 is white. Upright in this sense,
/// +x of the tag's frame is up and -y to the right.
std::span<const std::uint64_t, tag36h11_count> tag36h11_patterns();

}  // namespace ziggurat::render
