#include "physics/newton/articulation.h"

#include "dynamics/system.h"
#include "physics/convert.h"
#include "physics/newton/tree.h"

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

}  // namespace ziggurat::physics
