#pragma once
// Entities as trees of dynamics/.

#include <LinearMath/btTransform.h>

#include "dynamics/tree.h"
#include "physics/bodies.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Makes the tree of an entity where it stands, at rest. Its links are the body's parts.
/// @param body  without a core yet
dynamics::Tree make_tree(const Body& body, const scene::Entity& entity,
                         const scene::Physics& physics);

/// X_WP of a part.
btTransform transform_of(const dynamics::Tree& tree, std::size_t part);

/// The dof of a joint with a coordinate, and its index in the tree's q.
int dof_of(const dynamics::Tree& tree, std::size_t part);
int position_of(const dynamics::Tree& tree, std::size_t part);

}  // namespace ziggurat::physics
