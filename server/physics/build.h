// SPDX-License-Identifier: MIT
#pragma once
// Links of an entity, and its rigid parts, before the core moves it.

#include <LinearMath/btTransform.h>

#include "physics/bodies/bodies.h"
#include "physics/multibody/tree.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A box, a cylinder, a robot on wheels, or a prototype of one link without magnets is a single
/// part. Otherwise links on fixed joints are parts of what carries them.
bool is_single_part(const scene::Entity& entity);

/// The plane that an entity stands on, if there is one.
const scene::Plane* plane_of(const scene::Entity& entity, const scene::Physics& physics);

/// An entity where it stands; the core does not move it yet.
/// @param physics  whether magnets act: then free spherical magnets are carried; what planes hold
/// @param number   of the entity, into State::origins
Body make_body(const scene::Entity& entity, const scene::Physics& physics, std::size_t number);

/// Makes the tree of an entity where it stands, at rest. Its links are the body's parts.
/// @param body  without a core yet
dynamics::Tree make_tree(const Body& body, const scene::Entity& entity,
                         const scene::Physics& physics);

}  // namespace ziggurat::physics
