#pragma once
// Spheres that turn freely in a socket, as the stigmergic block's magnets do.
//
// As links of their own they would need substeps below 0.2 ms: a 1 g sphere of 3 mm next to
// another turns at 1300 rad/s about its rest. Their spin carries no momentum worth the name, so
// the sphere's mass joins the link that carries it and its orientation relaxes in the field.

#include <vector>

#include "physics/bodies.h"

namespace ziggurat::physics {

/// Marks the links that are turning magnets and adds their masses to their carriers. A link is
/// one if it is a sphere at the end of the tree, on a spherical joint at its centre, with a magnet
/// at its centre, inside its carrier's shape, and if the carrier with all it carries is balanced
/// about its own centre and axes. Others stay links of the multi-body.
/// @param assembled  X_EL of all links
void carry_turning_magnets(std::vector<LinkBody>& links, const scene::Entity& entity,
                           const std::vector<math::Pose>& assembled);

/// Whether a magnet sits at the centre of a sphere that turns freely.
bool turns_freely(const LinkBody& link, const scene::Magnet& magnet);

}  // namespace ziggurat::physics
