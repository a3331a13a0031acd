// SPDX-License-Identifier: MIT
#pragma once
// A body as a tree of the system: part i is link i of the tree.

#include <LinearMath/btTransform.h>
#include <LinearMath/btVector3.h>

#include <cstddef>
#include <span>

namespace ziggurat::dynamics {
class System;
class Tree;
}  // namespace ziggurat::dynamics

namespace ziggurat::physics {

/// Twist of a part or a link.
struct Twist {
  btVector3 velocity{0, 0, 0};          ///< of the centre of mass, in the world [m/s]
  btVector3 angular_velocity{0, 0, 0};  ///< in the world [rad/s]
};

/// Tree of a body in the system.
struct Articulation {
  dynamics::System* system = nullptr;
  std::size_t index = 0;  ///< of the tree: the entity's number

  dynamics::Tree& tree() const;
  btTransform transform(std::size_t part) const;
  void apply_force(std::size_t part, const btVector3& force) const;  ///< at the centre of mass [N]
  void apply_torque(std::size_t part, const btVector3& torque) const;  ///< [N m]
  void motions(std::span<Twist> out) const;
  bool sleeps() const;
};

/// X_WP of a part.
btTransform transform_of(const dynamics::Tree& tree, std::size_t part);

/// The dof of a joint with a coordinate, and its index in the tree's q.
int dof_of(const dynamics::Tree& tree, std::size_t part);
int position_of(const dynamics::Tree& tree, std::size_t part);

}  // namespace ziggurat::physics
