// SPDX-License-Identifier: MIT
#pragma once
// Colours of the floor as pixels over the arena: the scene's picture, and what was painted over it.

#include <array>
#include <cstdint>
#include <vector>

#include "render/model.h"
#include "world/floor.h"

namespace ziggurat::render {

struct FloorPicture {
  unsigned width = 0, height = 0;  ///< [px]
  std::vector<std::uint8_t> rgba;  ///< rows from -y to +y; without a colour transparent
  std::array<float, 256> light{};  ///< linear light of a channel
};

/// Its size depends on the model alone.
FloorPicture floor_picture(const Model& model, const std::vector<world::FloorPaint>& painted);

}  // namespace ziggurat::render
