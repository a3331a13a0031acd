// SPDX-License-Identifier: MIT
#pragma once
// Two magnets close together: the exact field of one, integrated over the pole charges M.n on the
// surface of the other.

#include "magnetism/dipole.h"
#include "magnetism/shape.h"

namespace ziggurat::magnetism {

/// A shape with its moment somewhere in the world.
struct PlacedShape {
  const Shape* shape;
  Vector3 position = Vector3::Zero();                      ///< of the centre [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from the shape's axes to the world
  Vector3 moment = Vector3::Zero();                        ///< in the world [A m^2]
};

/// @param first, second  at least one box or cylinder
/// @param tolerance      relative, of force and torque
Interaction charge_pair(const PlacedShape& first, const PlacedShape& second, double tolerance);

}  // namespace ziggurat::magnetism
