#pragma once
// Poses of an entity's links when it is assembled: joints decide, not the links' own positions
// (except the reference link's).

#include <vector>

#include "math/pose.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// X_EL of every link with all joint coordinates at zero, in the order of Entity::links.
std::vector<math::Pose> assemble(const scene::Entity& entity);

}  // namespace ziggurat::physics
