// SPDX-License-Identifier: MIT
#include "physics/stepping/impact.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::dynamics {
namespace {

constexpr int most_rebounds = 8;  // of an island at an instant; further impacts are inelastic
constexpr int most_impacts = 32;  // of an island at an instant

bool is_restitution_contact(const Constraint& constraint) {
  return constraint.kind == Constraint::Kind::contact &&
         constraint.law == Constraint::Law::contact && constraint.restitution > 0;
}

double separation_velocity(const Problem& problem, const Constraint& constraint) {
  double u[Constraint::most_rows];
  problem.constraint_velocity(constraint, u);
  return u[0];
}

/// Whether motors or wrenches change velocities at once.
bool has_sudden_forces(const Problem& problem) {
  const auto acts = [](const Wrench& wrench) {
    return !wrench.moment.isZero(0) || !wrench.force.isZero(0);
  };
  return std::ranges::any_of(problem.constraints,
                             [](const Constraint& constraint) {
                               return constraint.kind == Constraint::Kind::servo;
                             }) ||
         std::ranges::any_of(problem.trees, [&](const Tree* tree) {
           return std::ranges::any_of(tree->external, acts);
         });
}

/// Time at which a gap closes, and its closing velocity then.
struct Crossing {
  double time = HUGE_VAL;  ///< [s]
  double velocity = 0;     ///< [m/s]
};

/// First zero of gap + velocity t + acceleration t^2 / 2, from above.
Crossing crossing(double gap, double velocity, double acceleration) {
  gap = std::max(gap, 0.0);
  const double square = velocity * velocity - 2 * acceleration * gap;
  if (square < 0) return {};
  const double root = std::sqrt(square);
  if (velocity < 0) return {2 * gap / (root - velocity), root};
  if (acceleration < 0) return {(velocity + root) / -acceleration, root};
  return {};
}

/// Mean velocity change of a tree by sudden forces is not known before the step's end: of both
/// estimates the earlier.
Crossing first_crossing(const Constraint& contact, double before, double after, double time_step,
                        bool has_sudden) {
  const Crossing steady = crossing(contact.gap, before, (after - before) / time_step);
  if (!has_sudden) return steady;
  const Crossing at_once = crossing(contact.gap, after, 0);
  return at_once.time < steady.time ? at_once : steady;
}

/// Momenta of the present velocities.
void set_momentum(Problem& problem) {
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const int n = problem.trees[i]->dofs, first = problem.offset[i];
    const double* mass = problem.mass_of(i);
    for (int r = 0; r < n; ++r) {
      double sum = 0;
      for (int c = 0; c < n; ++c) sum += mass[r * n + c] * problem.velocity[first + c];
      problem.momentum[first + r] = sum;
    }
  }
}

/// Work of all impulses but those of servos, between two velocities and with a share of a change of
/// both impulses and velocities: constant, linear and quadratic coefficient of the share [J].
struct Work {
  double constant = 0, linear = 0, quadratic = 0;
};

Work work_of(const Problem& problem, const ImpactMemory& memory) {
  Work work;
  double before[Constraint::most_rows], least[Constraint::most_rows], most[Constraint::most_rows];
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& constraint = problem.constraints[k];
    if (constraint.kind == Constraint::Kind::servo) continue;
    problem.constraint_velocity(constraint, before, memory.velocity.data());
    problem.constraint_velocity(constraint, least, memory.inelastic.data());
    problem.constraint_velocity(constraint, most, problem.velocity.data());
    for (int r = 0; r < constraint.rows; ++r) {
      const double impulse = memory.impulses[k][r], more = constraint.impulse[r] - impulse,
                   faster = most[r] - least[r];
      work.constant += impulse * (before[r] + least[r]) / 2;
      work.linear += (impulse * faster + more * (before[r] + least[r])) / 2;
      work.quadratic += more * faster / 2;
    }
  }
  return work;
}

/// Largest share of a rebound whose contacts do no work in sum: 1, or less with several contacts or
/// friction.
double passive_share(const Work& work) {
  if (work.constant + work.linear + work.quadratic <= 0) return 1;
  if (work.constant >= 0 || work.quadratic <= 0) return 0;
  const double root = std::sqrt(work.linear * work.linear - 4 * work.quadratic * work.constant);
  return std::clamp((root - work.linear) / (2 * work.quadratic), 0.0, 1.0);
}

/// Solves one impact whose target velocities are set, without gain of energy.
void solve_impact(Problem& problem, VelocitySolver& solver, ImpactMemory& memory) {
  constexpr double rounding = 1e-9;  // of the work that the contacts could do
  memory.velocity = problem.velocity;
  set_momentum(problem);
  solver.solve(problem);
  double work = 0, size = 0;
  double before[Constraint::most_rows], after[Constraint::most_rows];
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind == Constraint::Kind::servo) continue;
    problem.constraint_velocity(constraint, before, memory.velocity.data());
    problem.constraint_velocity(constraint, after);
    for (int r = 0; r < constraint.rows; ++r) {
      work += constraint.impulse[r] * (before[r] + after[r]) / 2;
      size += std::abs(constraint.impulse[r] * before[r]);
    }
  }
  if (work <= rounding * size) return;
  memory.elastic = problem.velocity;
  const auto& elastic = memory.elastic;
  auto& elastic_impulses = memory.impulses;
  elastic_impulses.clear();
  for (Constraint& constraint : problem.constraints) {
    elastic_impulses.push_back(constraint.impulse);
    if (constraint.kind == Constraint::Kind::contact) constraint.target_velocity[0] = 0;
  }
  problem.velocity = memory.velocity;
  solver.solve(problem);
  memory.inelastic = problem.velocity;
  problem.velocity = elastic;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k)
    std::swap(problem.constraints[k].impulse, elastic_impulses[k]);
  const double share = passive_share(work_of(problem, memory));
  for (std::size_t k = 0; k < elastic.size(); ++k) {
    problem.velocity[k] = memory.inelastic[k] + share * (elastic[k] - memory.inelastic[k]);
  }
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    Constraint& constraint = problem.constraints[k];
    for (int r = 0; r < constraint.rows; ++r) {
      constraint.impulse[r] =
          memory.impulses[k][r] + share * (constraint.impulse[r] - memory.impulses[k][r]);
    }
  }
}

/// Sets the laws and targets of the next impact at an instant.
/// @param impacts  number of impacts before
/// @return         whether a contact approaches
bool prepare_impact(Problem& problem, const ImpactMemory& memory, int impacts) {
  constexpr double rounding = 1e-9;  // of a velocity after an impact [m/s]
  const double least = impacts == 0 ? restitution_threshold : rounding;
  bool approaches = false;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    Constraint& constraint = problem.constraints[k];
    constraint.impulse.fill(0);
    constraint.compliance = 0;
    if (constraint.kind == Constraint::Kind::limit) constraint.target_velocity[0] = 0;
    if (constraint.kind != Constraint::Kind::contact) continue;
    constraint.target_velocity.fill(0);
    const double before = separation_velocity(problem, constraint);
    const bool strikes =
        constraint.gap <= touching_gap && constraint.restitution > 0 && before < -least;
    constraint.law = strikes || memory.carries[k] ? Constraint::Law::contact : Constraint::Law::off;
    const bool rebounds = strikes && impacts < most_rebounds && before < -restitution_threshold;
    if (rebounds) constraint.target_velocity[0] = -constraint.restitution * before;
    approaches |= strikes;
  }
  return approaches;
}

}  // namespace

double find_first_impact(Problem& problem, VelocitySolver& solver, ImpactMemory& memory) {
  memory.closing.clear();
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    Constraint& constraint = problem.constraints[k];
    if (!is_restitution_contact(constraint)) continue;
    const double velocity = separation_velocity(problem, constraint);
    const bool touches = constraint.gap <= touching_gap;
    if (touches && std::abs(velocity) <= restitution_threshold) continue;
    memory.closing.push_back({static_cast<int>(k), velocity});
  }
  if (memory.closing.empty()) return HUGE_VAL;
  memory.velocity = problem.velocity;
  memory.impulses.clear();
  for (const auto& [index, velocity] : memory.closing) {
    Constraint& constraint = problem.constraints[index];
    memory.impulses.push_back(constraint.impulse);
    constraint.law = Constraint::Law::off;
    constraint.impulse.fill(0);
  }
  solver.solve(problem);
  const bool has_sudden = has_sudden_forces(problem);
  double first = HUGE_VAL;
  for (std::size_t i = 0; i < memory.closing.size(); ++i) {
    const auto& [index, before] = memory.closing[i];
    Constraint& constraint = problem.constraints[index];
    const Crossing found =
        first_crossing(constraint, before, separation_velocity(problem, constraint),
                       problem.time_step, has_sudden);
    if (found.velocity >= restitution_threshold) {
      first = std::min(first, found.time);
    } else {
      constraint.law = Constraint::Law::contact;
      constraint.impulse = memory.impulses[i];
    }
  }
  problem.velocity = memory.velocity;
  return first;
}

bool apply_impact_law(Problem& problem, VelocitySolver& solver, ImpactMemory& memory) {
  memory.carries.clear();
  for (Constraint& constraint : problem.constraints) {
    const bool touches = constraint.law != Constraint::Law::off && constraint.gap <= touching_gap;
    memory.carries.push_back(touches &&
                             (constraint.impulse[0] != 0 || constraint.restitution == 0));
    if (constraint.kind == Constraint::Kind::limit && !touches) constraint.upper = 0;
  }
  memory.sum.assign(problem.constraints.size(), {});
  int impacts = 0;
  for (; impacts < most_impacts && prepare_impact(problem, memory, impacts); ++impacts) {
    solve_impact(problem, solver, memory);
    for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
      for (int r = 0; r < problem.constraints[k].rows; ++r)
        memory.sum[k][r] += problem.constraints[k].impulse[r];
    }
  }
  for (std::size_t k = 0; k < problem.constraints.size(); ++k)
    problem.constraints[k].impulse = memory.sum[k];
  return impacts > 0;
}

}  // namespace ziggurat::dynamics
