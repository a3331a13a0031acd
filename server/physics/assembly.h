#pragma once
// Where an entity's links stand when it is assembled: joints decide, not the links' own
// positions (except the reference link's).

#include <vector>

#include "math/pose.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// X_EL of every link with all joint coordinates at zero, in the order of Entity::links.
std::vector<math::Pose> assemble(const scene::Entity& entity);

/// From a link's bottom-centre frame to its centre of mass, both with the same axes [m].
math::Vector3 center_of_mass(const scene::Geometry& geometry);

/// Principal moments of inertia of the solid about its centre of mass [kg m^2].
math::Vector3 inertia(const scene::Geometry& geometry, double mass);

}  // namespace ziggurat::physics
