#include "dynamics/restitution_energy.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "dynamics/energy_error.h"

namespace ziggurat::dynamics {
namespace {

constexpr double rounding = 1e-9;  // of the energy

/// Work of pushes, without gravity: they act at once, before any impact [J].
double work_of_pushes(const Problem& problem, Workspace& work) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs;
    work.scratch.resize(n);
    external_forces(tree, work, work.scratch, true, false);
    const Eigen::Map<const Eigen::VectorXd> force(work.scratch.data(), n);
    if (force.isZero(0)) continue;
    const Eigen::VectorXd impulse = problem.time_step * force;
    const Eigen::MatrixXd mass = Eigen::Map<const Eigen::MatrixXd>(problem.mass_of(i), n, n);
    const Eigen::Map<const Eigen::VectorXd> before(tree.v.data(), n);
    sum += impulse.dot(before + mass.llt().solve(impulse) / 2);
  }
  return sum;
}

/// Work of servos in the substep, of which v is the solution. Their additional impulses act in the
/// impacts, at the velocity after them.
double work_of_servos(const Problem& problem, const Iterate& without) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const Constraint& constraint = problem.constraints[i];
    if (constraint.kind != Constraint::Kind::servo || constraint.impulse[0] == 0) continue;
    const double* before = problem.trees[constraint.a]->v.data();
    const double* after = problem.velocity.data() + problem.offset[constraint.a];
    const double usual = without.impulses[i][0], more = constraint.impulse[0] - usual;
    for (const int k : constraint.dofs_a) {
      const double along = problem.jacobian[constraint.jacobian_a + k], most = usual * along * after[k];  // it may be stopped at once, as by a limit
      sum += std::min(usual * along * (before[k] + after[k]) / 2, most) + more * along * after[k];
    }
  }
  return sum;
}

/// Sets the velocities of all trees to share_a * a + share_b * b.
void set_velocities(const Problem& problem, double share_a, const std::vector<double>& a,
                    double share_b, const std::vector<double>& b) {
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs; ++k) {
      tree.v[k] = share_a * a[problem.offset[i] + k] + share_b * b[problem.offset[i] + k];
    }
    velocity_kinematics(tree);
  }
}

double kinetic_energy(const Problem& problem) {
  double sum = 0;
  for (const Tree* tree : problem.trees) sum += kinetic_energy(*tree);
  return sum;
}

/// Whether the world touches it: its momentum is not its own.
bool is_grounded(const Problem& problem) {
  return std::any_of(problem.constraints.begin(), problem.constraints.end(), [](const Constraint& constraint) {
    return constraint.kind == Constraint::Kind::contact && (constraint.a < 0 || constraint.b < 0);
  });
}

/// Takes an energy from all speeds, as far as they have it.
void scale_velocities(const Problem& problem, double excess) {
  const double all = kinetic_energy(problem);
  if (excess <= rounding * all) return;
  const double share = excess < all ? std::sqrt(1 - excess / all) : 0;
  for (Tree* tree : problem.trees) {
    for (double& speed : tree->v) speed *= share;
    velocity_kinematics(*tree);
  }
}

/// Step length that removes an energy: a t - b t^2 = energy, or where that is largest.
double way_back(double a, double b, double energy) {
  if (a <= 0) return 0;
  const double square = a * a - 4 * b * energy;
  const double way = square > 0 ? 2 * energy / (a + std::sqrt(square)) : a / (2 * b);
  return std::min(1.0, way);
}

}  // namespace

bool rebounds(const Problem& problem) {
  return std::ranges::any_of(problem.constraints, [&](const Constraint& constraint) { return problem.rebounded(constraint); });
}

void compute_energy_bound(Problem& problem, VelocitySolver& solver, Workspace& work, RestitutionEnergy& out) {
  solver.solve_without_rebound(problem, out.without);
  out.most_energy = energy(problem.trees) + work_of_servos(problem, out.without) + work_of_pushes(problem, work);
}

void bound_energy(const Problem& problem, Workspace& work, RestitutionEnergy& rebound) {
  const double now = energy(problem.trees), excess = now - rebound.most_energy;
  const double kinetic = kinetic_energy(problem);
  if (excess <= rounding * (kinetic + std::abs(now))) return;
  std::vector<double>&after = rebound.after, &change = rebound.change;
  after.resize(problem.velocity.size());
  change.resize(after.size());
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    for (int k = 0; k < tree.dofs; ++k) {
      const std::size_t index = problem.offset[i] + k;
      after[index] = tree.v[k];
      change[index] = rebound.without.velocity[index] - tree.v[k];
    }
  }
  set_velocities(problem, 0, after, 1, change);
  const double of_change = kinetic_energy(problem);
  set_velocities(problem, 1, after, 1, change);
  const double slope = kinetic + of_change - kinetic_energy(problem);
  const double way = way_back(slope, of_change, excess);
  set_velocities(problem, 1, after, way, change);
  remove_kinetic_energy(problem.trees, work, energy(problem.trees) - rebound.most_energy);
  if (is_grounded(problem)) scale_velocities(problem, energy(problem.trees) - rebound.most_energy);
}

}  // namespace ziggurat::dynamics
