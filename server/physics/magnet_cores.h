#pragma once
// Cores of magnets: balls that magnets of other entities can't enter, because colliders are in
// between.

#include "physics/bodies.h"

namespace ziggurat::physics {

/// Sets the core of each magnet: 0.9 of the radius of the ball about it that its link's collider
/// holds. Contact keeps such balls apart; the tenth is for what bodies overlap while a contact is
/// being undone. 0 where the entity has magnets on several parts, which do pass through each other.
/// @param body  with its parts
void set_magnet_cores(Body& body, const scene::Entity& entity);

}  // namespace ziggurat::physics
