// SPDX-License-Identifier: MIT
#pragma once
// Small trees for tests.

#include <cmath>
#include <vector>

#include "physics/multibody/tree.h"

namespace ziggurat::dynamics::testing {

inline constexpr double g = 9.81;  // [m/s^2]

/// A link like a box of the given sides [m].
inline Link box_link(const Vector3& sides, double mass) {
  Link link;
  link.mass = mass;
  const Vector3 square = sides.cwiseProduct(sides);
  link.inertia = Vector3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
  link.inertia *= mass / 12;
  return link;
}

inline Tree box(const Vector3& sides, double mass, const math::Pose& pose) {
  return Tree({box_link(sides, mass)}, pose);
}

inline Link ground() {
  Link link;
  link.joint = JointType::fixed;
  return link;
}

/// A link on a joint to link `parent`, at a place in it; its centre of mass hangs `below` the
/// joint.
inline Link hung(Link link, int parent, JointType joint, const Vector3& axis,
                 const Vector3& in_parent, const Vector3& below) {
  link.parent = parent;
  link.joint = joint;
  link.axis = axis;
  link.joint_in_parent.position = in_parent;
  link.joint_in_link.position = -below;
  return link;
}

/// Rods on revolute joints about y, hanging from each other, the first from the world's origin.
/// All lie along x when the joints are at 0.
/// @param end_mass  of a point at the far end of the last [kg]
inline Tree chain(int count, double length, double mass, double end_mass = 0) {
  std::vector<Link> links{ground()};
  for (int i = 0; i < count; ++i) {
    Link rod = box_link({length, 0.01, 0.01}, mass);
    Vector3 middle(length / 2, 0, 0);
    if (end_mass > 0 && i + 1 == count) {
      const double total = mass + end_mass;
      const double centre = (mass * length / 2 + end_mass * length) / total;
      const double steiner =
          mass * std::pow(centre - length / 2, 2) + end_mass * std::pow(length - centre, 2);
      rod.mass = total;
      rod.inertia += Vector3(1e-6 * end_mass, steiner, steiner);
      middle.x() = centre;
    }
    const Vector3 from = i == 0 ? Vector3::Zero() : Vector3(length / 2, 0, 0);
    links.push_back(hung(rod, i, JointType::revolute, Vector3::UnitY(), from, middle));
  }
  return Tree(links, {});
}

inline void weigh(Tree& tree) { tree.gravity = Vector3(0, 0, -g); }

/// Kinetic and gravitational energy [J].
inline double energy(const Tree& tree) {
  double total = kinetic_energy(tree);
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    total += g * tree.links[i].mass * tree.position[i].z();
  }
  return total;
}

}  // namespace ziggurat::dynamics::testing
