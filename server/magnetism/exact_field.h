// SPDX-License-Identifier: MIT
#pragma once
// The exact field of a uniformly magnetised box or cylinder, magnetised in any direction.

#include "magnetism/shape.h"

namespace ziggurat::magnetism {

/// Flux density outside a box, by the sum over its corners (inside: mu0 H).
/// @param size           full edge lengths [m]
/// @param magnetisation  in the box's frame [A/m]
/// @param point          in the box's frame [m]
/// @returns [T]
Vector3 box_field(const Vector3& size, const Vector3& magnetisation, const Vector3& point);

/// Flux density outside a cylinder: its lateral surface carries the current of the axial and the
/// charge of the transverse magnetisation; along z they are integrated in closed form, around the
/// axis by the trapezoidal rule, which converges exponentially.
/// @param magnetisation  in the cylinder's frame, z the axis [A/m]
/// @param point          in the cylinder's frame [m]
/// @param tolerance      relative, decides on the number of nodes
/// @returns [T]
Vector3 cylinder_field(const Cylinder& cylinder, const Vector3& magnetisation, const Vector3& point,
                       double tolerance);

/// Exact field of a magnet with this total moment [A m^2]; its shape must be a box or a cylinder.
Vector3 shape_field(const Shape& shape, const Vector3& moment, const Vector3& point,
                    double tolerance);

/// The point itself, or, if it is inside a box or a cylinder or on its surface, one just outside of
/// the nearest face [m].
Vector3 outside(const Shape& shape, const Vector3& point);

/// Distance from a point to the surface; zero inside [m].
double distance_outside(const Shape& shape, const Vector3& point);

}  // namespace ziggurat::magnetism
