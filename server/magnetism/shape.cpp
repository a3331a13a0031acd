// SPDX-License-Identifier: MIT
#include "magnetism/shape.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::magnetism {
namespace {

struct Volume {
  double operator()(const PointShape&) const { return 0; }
  double operator()(const Sphere& s) const { return 4 * pi / 3 * s.radius * s.radius * s.radius; }
  double operator()(const Box& b) const { return b.size.prod(); }
  double operator()(const Cylinder& c) const { return pi * c.radius * c.radius * c.height; }
};

struct BoundingRadius {
  double operator()(const PointShape&) const { return 0; }
  double operator()(const Sphere& s) const { return s.radius; }
  double operator()(const Box& b) const { return b.size.norm() / 2; }
  double operator()(const Cylinder& c) const {
    return std::sqrt(c.radius * c.radius + c.height * c.height / 4);
  }
};

struct LongestSide {
  double operator()(const PointShape&) const { return 0; }
  double operator()(const Sphere& s) const { return 2 * s.radius; }
  double operator()(const Box& b) const { return b.size.maxCoeff(); }
  double operator()(const Cylinder& c) const { return std::max(2 * c.radius, c.height); }
};

}  // namespace

double volume(const Shape& shape) { return std::visit(Volume{}, shape); }
double bounding_radius(const Shape& shape) { return std::visit(BoundingRadius{}, shape); }
double longest_side(const Shape& shape) { return std::visit(LongestSide{}, shape); }

}  // namespace ziggurat::magnetism
