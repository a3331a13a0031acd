// SPDX-License-Identifier: MIT
#pragma once
// A uniformly magnetised body as a few weighted dipoles of one direction. Outside, only the
// harmonic moments of the body's volume count, M_l(n) = <|x|^l P_l(x.n / |x|)>: a rule is as good
// as the moments that it shares with the body, and the first that differs gives its error.

#include <array>
#include <vector>

#include "magnetism/shape.h"

namespace ziggurat::magnetism {

/// Points in the shape's frame and their shares of the moment. The centre is kept apart.
struct Rule {
  std::vector<Vector3> points;  ///< [m]
  std::vector<double> weights;  ///< of the points
  double centre_weight = 1;     ///< of the centre; all weights sum to one
};

/// The centre alone.
Rule point_rule();

/// The fewest points that share the second moments: one for spheres and cubes, two to four else.
Rule coarse_rule(const Shape& shape);

/// Points that share the moments up to the fifth order at least.
Rule fine_rule(const Shape& shape);

/// Sizes of the moments of orders 0, 2, 4, 6, 8, the largest over directions [m^l]; odd ones
/// vanish.
using Moments = std::array<double, 5>;

/// Moments of the body.
Moments moments(const Shape& shape);
/// Moments of the rule's error.
Moments residual(const Rule& rule, const Shape& shape);

/// Centre distances of two equal magnets from which on the relative error of force and torque
/// stays within the tolerance, whatever their orientations.
struct Reach {
  double point = 0;   ///< one dipole each [m]
  double coarse = 0;  ///< coarse rule against coarse rule
  double mixed = 0;   ///< fine rule against one dipole, both ways, less one dipole each [m]
  double fine = 0;    ///< fine rule against fine rule
};

Reach reach(const Shape& shape, double tolerance);

}  // namespace ziggurat::magnetism
