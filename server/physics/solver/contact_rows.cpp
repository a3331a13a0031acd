// SPDX-License-Identifier: MIT
// Jacobian rows of contacts.

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {
namespace {

/// Sets the R Jacobian rows of a contact on one side, and adds J_k^2 / M_kk of each dof to their
/// mobility.
/// @param frame  its directions, away from the side;  @param arm  of its point from the origin [m]
/// @param inverse_mass  of the tree's dofs, see Problem
template <int R>
void set_contact_rows(const Tree& tree, std::span<const int> dofs, const Matrix3& frame,
                      const Vector3& arm, const double* inverse_mass, double* out,
                      double* mobility) {
  const std::size_t size = dofs.size();
  const std::size_t root = tree.has_floating_base ? 6 : 0;  // dofs along the world's axes
  double sum[R] = {};
  if (root > 0) {
    const double turning[] = {inverse_mass[0], inverse_mass[1], inverse_mass[2]};
    const double moving = inverse_mass[3];  // along any unit vector
    for (int r = 0; r < R; ++r) {
      const Vector3 direction = frame.col(r % 3);
      const Vector3 moment = r < 3 ? Vector3(arm.cross(direction)) : direction;
      double* row = out + r * size;
      for (int k = 0; k < 3; ++k) {
        row[k] = moment[k];
        row[3 + k] = r < 3 ? direction[k] : 0;
      }
      sum[r] = moment[0] * moment[0] * turning[0] + moment[1] * moment[1] * turning[1] +
               moment[2] * moment[2] * turning[2] + (r < 3 ? moving : 0);
    }
  }
  for (std::size_t e = root; e < size; ++e) {
    const Motion& axis = tree.motion_subspace[dofs[e]];
    const double inverse = inverse_mass[dofs[e]];
    const Vector3 speed = axis.linear + axis.angular.cross(arm);
    for (int r = 0; r < R; ++r) {
      const double entry = r < 3 ? frame.col(r % 3).dot(speed) : frame.col(r % 3).dot(axis.angular);
      out[r * size + e] = entry;
      sum[r] += entry * entry * inverse;
    }
  }
  for (int r = 0; r < R; ++r) mobility[r] += sum[r];
}

}  // namespace

/// Adds the Jacobian rows of a contact on one side.
/// @param sign  1: side a, -1: side b
void Problem::add_contact_rows(const Tree& tree, int link, const Vector3& point,
                               Constraint& constraint, double sign) {
  const std::span<const int> dofs = tree.dofs_of(link);
  (sign > 0 ? constraint.dofs_a : constraint.dofs_b) = dofs;
  double* const out = add_rows(constraint.rows, dofs.size(),
                               sign > 0 ? constraint.jacobian_a : constraint.jacobian_b);
  const double* inverse = inverse_mass.data() + offset[sign > 0 ? constraint.a : constraint.b];
  const Matrix3 frame = sign * constraint.frame;
  dispatch_rows(constraint.rows, [&](auto rows) {
    set_contact_rows<rows()>(tree, dofs, frame, point - tree.origin, inverse, out,
                             constraint.mobility.data());
  });
}

}  // namespace ziggurat::dynamics
