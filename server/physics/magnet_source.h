// SPDX-License-Identifier: MIT
#pragma once
// A scene's magnet in the terms of magnetism/.

#include <vector>

#include "magnetism/shape.h"
#include "physics/bodies/bodies.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A point where the scene gives no shape.
magnetism::Shape shape_of(const scene::Magnet& magnet);

/// Without current, in the anchor frame [A m^2].
math::Vector3 passive_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism);

/// Per unit of current, in the anchor frame [A m^2].
math::Vector3 active_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism);

/// Sets the core of each magnet: 0.9 of the radius of the ball about it that its link's collider
/// holds. Contact keeps such balls apart; the tenth is for what bodies overlap while a contact is
/// being undone. 0 where the entity has magnets on several parts, which do pass through each other.
/// @param body  with its parts
void set_magnet_cores(Body& body, const scene::Entity& entity);

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
