// SPDX-License-Identifier: MIT
// Start of a solver: the last substep's solution, turned with its tree.

#include <cmath>

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {
namespace {

/// Turns the two rows of a contact's tangents about its normal.
void rotate_tangents(double* rows, double sine, double cosine) {
  const double first = rows[0], second = rows[1];
  rows[0] = cosine * first - sine * second;
  rows[1] = sine * first + cosine * second;
}

}  // namespace

void turn_start(Problem& problem) {
  constexpr double least = 1e-9;      // what rests is left as it is [rad]
  constexpr double level = 1 - 1e-9;  // cosine of a normal's angle to the vertical
  if (problem.trees.size() != 1 || !problem.trees[0]->has_floating_base) return;
  const Tree& tree = *problem.trees[0];
  const Vector3 turn = problem.time_step * tree.spatial_velocity[0].angular;
  if (!(turn.squaredNorm() > least * least)) return;
  const Vector3 up = -tree.gravity.normalized();
  const double angle = up.dot(turn), sine = std::sin(angle), cosine = std::cos(angle);
  for (double* vector : {problem.velocity.data(), problem.velocity.data() + 3}) {
    Eigen::Map<Vector3> it(vector);
    const Vector3 before = it;
    it = cosine * before + sine * up.cross(before) + (1 - cosine) * up.dot(before) * up;
  }
  for (Constraint& constraint : problem.constraints) {
    if (constraint.kind != Constraint::Kind::contact || constraint.rows == 1) continue;
    const double lean = up.dot(constraint.frame.col(0));
    if (std::abs(lean) < level) continue;
    const double about_normal = lean > 0 ? sine : -sine;
    rotate_tangents(constraint.impulse.data() + 1, about_normal, cosine);
    if (constraint.rows == 6) rotate_tangents(constraint.impulse.data() + 4, about_normal, cosine);
  }
}

}  // namespace ziggurat::dynamics
