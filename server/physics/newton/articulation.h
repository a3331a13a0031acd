#pragma once
// A body as a tree of dynamics/: part i is link i of the tree.

#include <LinearMath/btTransform.h>

#include <cstddef>
#include <span>

#include "physics/twist.h"

namespace ziggurat::dynamics {
class System;
class Tree;
}  // namespace ziggurat::dynamics

namespace ziggurat::physics {

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

}  // namespace ziggurat::physics
