// SPDX-License-Identifier: MIT
#pragma once
// Links on fixed joints move as one with the link that carries them: together they are a part.
//
// A part costs a tree as much as one link that moves, however many links it has, and its links
// cannot drift apart.

#include <vector>

#include "physics/bodies/bodies.h"

namespace ziggurat::physics {

/// Puts every link into a part, and gives each part the mass of its links, their common centre of
/// mass, and their principal axes; those of its first link where it is balanced about them.
/// @param links  turning magnets already with what carries them
/// @param assembled  X_EL of all links
/// @return the reference link's part, then the others from the root outwards; numbered as the
///         links of a tree
std::vector<Part> weld(std::vector<LinkBody>& links, const scene::Entity& entity,
                       const std::vector<math::Pose>& assembled);

}  // namespace ziggurat::physics
