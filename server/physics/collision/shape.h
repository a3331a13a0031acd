// SPDX-License-Identifier: MIT
#pragma once
// Physical properties of shapes. Each function is written for each shape in shape.cpp; a shape
// without one does not compile.
//
// S, the frame of a shape, is at its centre of mass, along its principal axes.

#include "physics/collision/shapes.h"
#include "scene/geometry.h"

namespace ziggurat::physics {

/// X_LS of a shape in its link. For all but hulls the axes are the link's.
math::Pose shape_frame(const scene::Geometry& geometry);

/// Principal moments of inertia of the solid [kg m^2].
math::Vector3 inertia(const scene::Geometry& geometry, double mass);

/// Half extents of the box about the shape and S's origin, along S's axes [m].
math::Vector3 half_extents(const scene::Geometry& geometry);

/// Radius of the largest ball about a point that the shape holds [m]; negative outside.
/// @param point  in S [m]
double depth(const scene::Geometry& geometry, const math::Vector3& point);

/// In S.
contact::Shape contact_shape(const scene::Geometry& geometry);

}  // namespace ziggurat::physics
