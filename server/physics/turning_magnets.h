#pragma once
// Magnetic spheres that turn freely in a socket, as those of the stigmergic block.
//
// As links of their own they would need substeps below 0.2 ms: two 1 g spheres of 3 mm side by side
// oscillate at 1300 rad/s. Their spin has hardly any momentum. So the sphere's mass joins the link
// that carries it, and its orientation relaxes in the field.

#include <vector>

#include "physics/bodies.h"

namespace ziggurat::physics {

/// Marks the links that are turning magnets and adds their masses to their carriers.
/// Such a link is a sphere at the end of the tree, on a spherical joint at its centre. It has a
/// magnet at its centre, and lies inside its carrier's shape.
/// The carrier with all its children must be balanced about its own centre and axes. Others stay
/// links of the tree.
/// @param assembled  X_EL of all links
void carry_turning_magnets(std::vector<LinkBody>& links, const scene::Entity& entity,
                           const std::vector<math::Pose>& assembled);

/// Whether a magnet sits at the centre of a sphere that turns freely.
bool turns_freely(const LinkBody& link, const scene::Magnet& magnet);

}  // namespace ziggurat::physics
