// SPDX-License-Identifier: MIT
#pragma once
// Shapes of uniformly magnetised bodies, centred on their own frame.

#include <variant>

#include "magnetism/dipole.h"

namespace ziggurat::magnetism {

/// Nothing is known but the moment.
struct PointShape {};

/// Outside, exactly a dipole at the centre.
struct Sphere {
  double radius;  ///< > 0 [m]
};

struct Box {
  Vector3 size = Vector3::Zero();  ///< full edge lengths, > 0 [m]
};

struct Cylinder {
  double radius;  ///< > 0 [m]
  double height;  ///< along z, > 0 [m]
};

using Shape = std::variant<PointShape, Sphere, Box, Cylinder>;

/// [m^3]; zero for a point.
double volume(const Shape& shape);

/// Radius of the smallest sphere around the centre that holds the shape [m].
double bounding_radius(const Shape& shape);

/// Longest extent: edge, diameter or height [m]; zero for a point.
double longest_side(const Shape& shape);

}  // namespace ziggurat::magnetism
