// SPDX-License-Identifier: MIT
#include "physics/bodies/articulation.h"

#include "physics/bodies/convert.h"
#include "physics/multibody/tree.h"
#include "physics/stepping/system.h"

namespace ziggurat::physics {

dynamics::Tree& Articulation::tree() const { return system->trees[index]; }

btTransform Articulation::transform(std::size_t part) const { return transform_of(tree(), part); }

void Articulation::apply_force(std::size_t part, const btVector3& force) const {
  system->apply_wrench(static_cast<int>(index), static_cast<int>(part),
                       {math::Vector3::Zero(), from_bullet(force)});
}

void Articulation::apply_torque(std::size_t part, const btVector3& torque) const {
  system->apply_wrench(static_cast<int>(index), static_cast<int>(part),
                       {from_bullet(torque), math::Vector3::Zero()});
}

void Articulation::motions(std::span<Twist> out) const {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int link = static_cast<int>(i);
    out[i] = {to_bullet(tree().velocity(link)), to_bullet(tree().angular_velocity(link))};
  }
}

bool Articulation::sleeps() const { return system->is_asleep(static_cast<int>(index)); }

btTransform transform_of(const dynamics::Tree& tree, std::size_t part) {
  const Eigen::Matrix3d& m = tree.rotation[part];
  return btTransform(
      btMatrix3x3(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)),
      to_bullet(tree.position[part]));
}

int dof_of(const dynamics::Tree& tree, std::size_t part) { return tree.first_dof[part]; }
int position_of(const dynamics::Tree& tree, std::size_t part) { return tree.first_position[part]; }

}  // namespace ziggurat::physics
