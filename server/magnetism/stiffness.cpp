// SPDX-License-Identifier: MIT
#include "magnetism/stiffness.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::magnetism {

std::array<Bond, 6> bonds(std::span<const Magnet> magnets, std::uint32_t body,
                          const BondedBody& bonded, double current) {
  std::array<Bond, 6> result;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1 : -1;
    Bond& bond = result[face];
    for (const Magnet& magnet : magnets) {
      if (magnet.body != body) continue;
      const double moment = (magnet.passive_moment + current * magnet.active_moment).norm();
      const double depth =
          bonded.half_extents[axis] - side * (magnet.position[axis] - bonded.offset[axis]);
      // Spheres cannot come closer than they are thick; nothing sits outside its own box.
      const double thickness = std::max(longest_side(magnet.shape), 1e-4);
      const double distance = std::max(2 * depth, thickness);
      const double stiffness = (magnet.freely_turning ? 6 : 12) * magnetic_constant * moment *
                               moment / std::pow(distance, 5);
      Vector3 lever = magnet.position;
      lever[axis] = 0;
      bond.stiffness += stiffness;
      bond.twist += stiffness * lever.squaredNorm();
    }
    bond.lateral_rate = std::sqrt(bond.stiffness / (bonded.mass / 2));
    bond.twist_rate = std::sqrt(bond.twist / (bonded.inertia[axis] / 2));
  }
  return result;
}

double stiffest_rate(std::span<const Magnet> magnets, std::uint32_t body, const BondedBody& bonded,
                     double current) {
  double rate = 0;
  for (const Bond& bond : bonds(magnets, body, bonded, current)) {
    rate = std::max({rate, bond.lateral_rate, bond.twist_rate});
  }
  return rate;
}

}  // namespace ziggurat::magnetism
