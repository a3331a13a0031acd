#pragma once
// Coordinates of joints, from the poses of the links that they connect.

#include "scene/scene.h"

namespace ziggurat::channels {

/// 0 as assembled; of fixed and spherical joints always.
/// @param parent, child  X_WL of the links
/// @return [m], or [rad] in [-pi, pi]: whole turns can't be seen
double position_of(const scene::Joint& joint, const math::Pose& parent, const math::Pose& child);

}  // namespace ziggurat::channels
