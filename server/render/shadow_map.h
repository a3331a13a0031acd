// SPDX-License-Identifier: MIT
#pragma once
// The shadow map: the depth of what the sun meets first, seen from it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/drawing.h"

namespace ziggurat::render {

/// Texels of depth, 0 to 1 away from the sun, with a margin that nothing is drawn in. They are kept
/// in blocks: a block is cleared when something is first drawn near it, and knows the least depth
/// of what is in or near it. So the cost grows with what throws shadows, not with the map.
class ShadowMap {
 public:
  static constexpr unsigned margin = 8, block = 16;  ///< [texels]
  static constexpr unsigned side = shadow_size + 2 * margin;
  static constexpr unsigned blocks = side / block;
  static_assert(blocks * block == side);

  /// Forgets what was drawn.
  void begin();

  /// A corner: x and y [texels], depth.
  struct Corner {
    double x, y, depth;
  };
  /// Draws a triangle, counterclockwise seen from the sun; nothing of others.
  void draw(const std::array<Corner, 3>& corners);

  /// The least depth of what reaches a lookup at a texel of the margin or the map; 1: nothing.
  float nearest(int x, int y) const {
    return nearest_[place(x) / block + place(y) / block * blocks];
  }
  /// Depths from a texel on, along x. Only where nearest() is less than 1.
  const float* texels(int x, int y) const {
    return &texels_[place(y) * std::size_t{side} + place(x)];
  }

 private:
  static unsigned place(int texel) { return static_cast<unsigned>(texel + int{margin}); }
  void open(unsigned left, unsigned right, unsigned low, unsigned high, float depth);

  std::vector<float> texels_;
  std::vector<float> nearest_;         // per block
  std::vector<std::uint8_t> is_open_;  // per block: cleared since begin()
};

}  // namespace ziggurat::render
