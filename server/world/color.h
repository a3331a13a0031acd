// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace ziggurat::world {

/// A colour as 0xRRGGBB. 0 is black; of lights it is off: not visible to anyone.
using Color = std::uint32_t;

}  // namespace ziggurat::world
