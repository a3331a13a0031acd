// SPDX-License-Identifier: MIT
#pragma once
// Products with the Jacobian of one side of a constraint: R rows, one after the other, each with an
// entry for each dof that moves the side. A floating base leads with six; the compiler knows their
// number, and takes two at a time.

#include <span>

#include "physics/multibody/spatial.h"

namespace ziggurat::dynamics {

using Pair = Eigen::Array2d;

/// Whether a side's dofs begin with the first six of its tree: those of a floating base, or of the
/// first joints of a fixed one.
inline bool begins_with_floating_base(std::span<const int> dofs) {
  return dofs.size() >= 6 && dofs[5] == 5;
}

/// Two values of a row, or of velocities.
inline Eigen::Map<const Pair> pair_at(const double* values) {
  return Eigen::Map<const Pair>(values);
}

/// u += J v.
/// @param v  velocities of the side's tree;  @param u  of each row
template <int R>
void add_velocity(const double* jacobian, std::span<const int> dofs, const double* v, double* u) {
  const std::size_t size = dofs.size(), root = begins_with_floating_base(dofs) ? 6 : 0;
  double sum[R] = {};
  if (root > 0) {
    const Pair a = pair_at(v), b = pair_at(v + 2), c = pair_at(v + 4);
    for (int r = 0; r < R; ++r) {
      const double* row = jacobian + r * size;
      const Pair both = pair_at(row) * a + pair_at(row + 2) * b + pair_at(row + 4) * c;
      sum[r] = both[0] + both[1];
    }
  }
  for (std::size_t e = root; e < size; ++e) {
    const double speed = v[dofs[e]];
    for (int r = 0; r < R; ++r) sum[r] += jacobian[r * size + e] * speed;
  }
  for (int r = 0; r < R; ++r) u[r] += sum[r];
}

/// out += J^T g.
/// @param g  impulse of each row;  @param out  of each dof of the side's tree
template <int R>
void add_impulse(const double* jacobian, std::span<const int> dofs, const double* g, double* out) {
  const std::size_t size = dofs.size(), root = begins_with_floating_base(dofs) ? 6 : 0;
  if (root > 0) {
    Pair a = pair_at(out), b = pair_at(out + 2), c = pair_at(out + 4);
    for (int r = 0; r < R; ++r) {
      const double* row = jacobian + r * size;
      a += pair_at(row) * g[r];
      b += pair_at(row + 2) * g[r];
      c += pair_at(row + 4) * g[r];
    }
    Eigen::Map<Pair> to_a(out), to_b(out + 2), to_c(out + 4);
    to_a = a, to_b = b, to_c = c;
  }
  for (std::size_t e = root; e < size; ++e) {
    double sum = out[dofs[e]];
    for (int r = 0; r < R; ++r) sum += jacobian[r * size + e] * g[r];
    out[dofs[e]] = sum;
  }
}

}  // namespace ziggurat::dynamics
