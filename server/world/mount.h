// SPDX-License-Identifier: MIT
#pragma once
// Place where a device is fixed.

#include <cstddef>
#include <optional>

#include "math/pose.h"

namespace ziggurat::world {

/// Mount of a device.
struct Mount {
  std::size_t entity = 0;           ///< into Layout::entities and State::origins
  std::optional<std::size_t> link;  ///< into State::links; none: the entity's origin frame
  math::Pose pose;                  ///< X_AD of the device in that frame
};

}  // namespace ziggurat::world
