// SPDX-License-Identifier: MIT
#pragma once
// Logarithm, arc tangent and decaying exponential from additions, multiplications and divisions
// only. The C library's versions are chosen by processor (with or without fused multiply-add) and
// may differ in the last bit; these give the same bits everywhere. Relative error below 1e-15.

namespace ziggurat::magnetism {

/// e^-x for x >= 0; zero from 700 on.
double decay(double x);

/// Natural logarithm of x > 0; arguments below 1e-300 count as 1e-300.
double logarithm(double x);

/// Angle of the point (x, y) from the x axis in [-pi, pi] [rad]; 0 at the origin.
double angle(double y, double x);

}  // namespace ziggurat::magnetism
