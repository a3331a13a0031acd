// SPDX-License-Identifier: MIT
#pragma once
// Closed forms from the literature, to check and to plot against.

#include "magnetism/dipole.h"

namespace ziggurat::magnetism {

/// Force between two parallel boxes, both magnetised along z (Akoun and Yonnet, IEEE Trans. Magn.
/// 20 (1984) 1962).
/// @param first_size, second_size  full edge lengths [m]
/// @param offset                   second centre minus first centre [m]
/// @param first_remanence, second_remanence  along z [T]
/// @returns force on the second [N]
Vector3 parallel_box_force(const Vector3& first_size, const Vector3& second_size,
                           const Vector3& offset, double first_remanence, double second_remanence);

/// Force between two coaxial cylinders of one radius, both magnetised along the axis (Vokoun et
/// al., JMMM 321 (2009) 3758): an integral over a Bessel function, done numerically.
/// @param gap  between the facing caps, > 0 [m]
/// @returns pull along the axis, positive where remanences of one sign attract [N]
double coaxial_cylinder_force(double radius, double first_height, double second_height, double gap,
                              double first_remanence, double second_remanence);

}  // namespace ziggurat::magnetism
