// SPDX-License-Identifier: MIT
#include "physics/stepping/unconstrained_trees.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ziggurat::dynamics {
namespace {

/// Velocity at which a contact resolves its penetration, without the correction for rotation [m/s].
double push_out_velocity(const Problem& problem, const Constraint& constraint) {
  return constraint.target_velocity[0] -
         problem.time_step / 2 * std::max(0.0, -constraint.gap_acceleration);
}

/// Whether a contact's impulse is small enough to be that of resolving a penetration.
bool may_only_push_out(const Problem& problem, const Constraint& constraint) {
  const double out = push_out_velocity(problem, constraint);
  return constraint.compliance > 0 && out > 0 &&
         std::abs(constraint.impulse[0]) * constraint.mobility[0] <= 2 * out;
}

/// Whether a constraint has a larger impulse, or a joint violates its limit, as at the start of a
/// scene.
bool holds(const Problem& problem, const Constraint& constraint) {
  return (constraint.impulse[0] != 0 && !may_only_push_out(problem, constraint)) ||
         (constraint.kind == Constraint::Kind::limit && constraint.gap < -problem.allowed_overlap);
}

/// Whether bodies cross a surface on the parabola of free fall, though their final velocity does
/// not say so.
bool crosses_surface(const Problem& problem, const Constraint& constraint) {
  if (constraint.kind != Constraint::Kind::contact) return false;
  const auto fall = [&](int index) -> Vector3 {
    if (index < 0 || !problem.trees[index]->has_floating_base) return Vector3::Zero();
    return problem.trees[index]->gravity;
  };
  const double pull = constraint.frame.col(0).dot(fall(constraint.a) - fall(constraint.b));
  if (pull <= 0) return false;  // as of all supported bodies
  double u[Constraint::most_rows];
  problem.constraint_velocity(constraint, u);
  return constraint.gap + problem.time_step * (u[0] - problem.time_step / 2 * pull) <
         -problem.allowed_overlap;
}

/// Finds the velocity of a tree without constraints.
void find_free_velocity(const Problem& problem, int index, Workspace& work,
                        UnconstrainedVelocities& out) {
  if (index < 0 || std::exchange(out.is_known[index], 1)) return;
  const Tree& tree = *problem.trees[index];
  compute_mass_matrix(tree, work);
  factor_mass_matrix(tree, work, problem.time_step);
  double* velocity = out.velocity.data() + problem.offset[index];
  std::copy_n(problem.momentum.data() + problem.offset[index], tree.dofs, velocity);
  solve_mass_matrix(tree, work, velocity);
}

/// Whether penetrating surfaces would approach without the contact. Its impulse tells little:
/// redundant contacts share the load.
bool closes_without_contact(const Problem& problem, const Constraint& constraint, Workspace& work,
                            UnconstrainedVelocities& memory) {
  constexpr double slow = 1e-3;  // of the push-out velocity
  find_free_velocity(problem, constraint.a, work, memory);
  find_free_velocity(problem, constraint.b, work, memory);
  double u[Constraint::most_rows];
  problem.constraint_velocity(constraint, u, memory.velocity.data());
  return u[0] < -slow * push_out_velocity(problem, constraint);
}

}  // namespace

std::size_t find_unconstrained(const Problem& problem, std::span<const Servo> servos,
                               Workspace& work, UnconstrainedVelocities& memory,
                               std::vector<unsigned char>& out) {
  std::size_t count = problem.trees.size();
  out.assign(count, 1);
  const auto touch = [&](const Constraint& constraint) {
    for (const int tree : {constraint.a, constraint.b})
      count -= tree >= 0 && std::exchange(out[tree], 0);
  };
  for (const Constraint& constraint : problem.constraints) {
    if (count == 0) return 0;
    const bool is_motor =
        constraint.kind == Constraint::Kind::servo && servos[constraint.source].dof >= 0;
    if (!is_motor && (holds(problem, constraint) || crosses_surface(problem, constraint)))
      touch(constraint);
  }
  memory.velocity.resize(problem.velocity.size());
  memory.is_known.assign(problem.trees.size(), 0);
  for (const Constraint& constraint : problem.constraints) {
    if (count == 0) return 0;
    const auto is_free = [&](int tree) { return tree >= 0 && out[tree]; };
    if (constraint.impulse[0] == 0 || !may_only_push_out(problem, constraint) ||
        !(is_free(constraint.a) || is_free(constraint.b)))
      continue;
    if (closes_without_contact(problem, constraint, work, memory)) touch(constraint);
  }
  for (std::size_t before = count + 1;
       0 < count && count < before;) {  // an impulse acts on both of its trees
    before = count;
    for (const Constraint& constraint : problem.constraints) {
      if (constraint.impulse[0] != 0 && constraint.a >= 0 && constraint.b >= 0 &&
          out[constraint.a] != out[constraint.b])
        touch(constraint);
    }
  }
  return count;
}

void clear_contact_impulses(Problem& problem, std::span<const unsigned char> free) {
  const auto stays = [&](int tree) { return tree >= 0 && !free[tree]; };
  for (Constraint& constraint : problem.constraints) {
    if (constraint.kind == Constraint::Kind::contact && !stays(constraint.a) &&
        !stays(constraint.b))
      constraint.impulse.fill(0);
  }
}

}  // namespace ziggurat::dynamics
