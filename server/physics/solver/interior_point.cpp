// SPDX-License-Identifier: MIT
// Interior point method for islands with impacts. Impulses and speeds of every contact stay inside
// their cones, and their product goes to zero. The number of steps hardly depends on the number and
// state of contacts.
//
// A contact's impulse z = (mu g_n, g_t) and speed s = (u_n / mu + |u_t|, u_t) lie in the cone x_0
// >= |(x_1, x_2)|. Their product is 0 where Coulomb's law holds. The term |u_t| keeps sliders from
// lifting off (G. de Saxce, Z.-Q. Feng, Math. Comput. Modelling 28, 1998).
// Steps are those of Nesterov and Todd with Mehrotra's corrector (L. Vandenberghe, The CVXOPT
// linear and quadratic cone program solvers, 2010, sections 4 and 5). They include the derivative
// of |u_t|, which makes the matrix unsymmetric. Without it convergence is linear and slow.

#include <algorithm>
#include <cmath>

#include "physics/solver/constraint_hessian.h"
#include "physics/solver/newton.h"

namespace ziggurat::dynamics {
namespace {

constexpr double compliance = 1e-8;         // of all impulses, over the mobility
constexpr double boundary_fraction = 0.95;  // of the way to the border of the cones
constexpr double least_centering = 1e-4;

double tangential(const Vector3& x) { return std::sqrt(x[1] * x[1] + x[2] * x[2]); }

/// x_0^2 - x_1^2 - x_2^2
double square(const Vector3& x) {
  const double t = tangential(x);
  return (x[0] - t) * (x[0] + t);
}

/// The Jordan product of the cone.
Vector3 product(const Vector3& a, const Vector3& b) {
  return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2], a[0] * b[1] + b[0] * a[1],
          a[0] * b[2] + b[0] * a[2]};
}

/// x with product(a, x) = b.
Vector3 quotient(const Vector3& a, const Vector3& b) {
  const double x = (a[0] * b[0] - a[1] * b[1] - a[2] * b[2]) / square(a);
  return {x, (b[1] - x * a[1]) / a[0], (b[2] - x * a[2]) / a[0]};
}

/// Step length along d from x to the boundary of the cone, at most 1.
double step_to_cone_boundary(const Vector3& x, const Vector3& d) {
  const double a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2];
  const double b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2];
  const double c = std::max(0.0, square(x));
  double step_length = d[0] < 0 ? std::min(1.0, -x[0] / d[0]) : 1;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return step_length;
  const double q = -(b + (b > 0 ? 1 : -1) * std::sqrt(discriminant));
  if (a != 0 && q / a > 0) step_length = std::min(step_length, q / a);
  if (q != 0 && c / q > 0) step_length = std::min(step_length, c / q);
  return step_length;
}

double step_to_bound(double x, double d) { return d < 0 ? std::min(1.0, -x / d) : 1; }

/// Rows that the method solves for; those of rolling and spinning friction keep their impulses.
int solved_rows(const Constraint& constraint) {
  const int acting = acting_rows(constraint);
  return acting >= 3 ? 3 : acting > 0 ? 1 : 0;
}

bool is_cone(const Constraint& constraint) { return solved_rows(constraint) == 3; }

/// Scaling of Nesterov and Todd, and what the speed gives of the impulse: dz = -slope A dv.
void scale_cone(InteriorPointConstraint& c) {
  const double ns = std::sqrt(square(c.speed)), nz = std::sqrt(square(c.impulse));
  const Vector3 s = c.speed / ns, z = c.impulse / nz;
  const double cosine = s[0] * z[0] + s[1] * z[1] + s[2] * z[2];
  const double gamma = 2 * std::sqrt((1 + cosine) / 2);
  const Vector3 w((s[0] + z[0]) / gamma, (s[1] - z[1]) / gamma, (s[2] - z[2]) / gamma);
  const double stretch = ns / nz, root = std::sqrt(stretch), rest = 1 / (1 + w[0]);
  Matrix3 squared;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double one = i == j ? 1 : 0;
      squared(i, j) = stretch * (2 * w[i] * w[j] + (i == 0 ? -one : one));
      const double entry = i == 0 ? w[j] : j == 0 ? w[i] : one + w[i] * w[j] * rest;
      c.scaling(i, j) = root * entry;
      c.inverse_scaling(i, j) = ((i == 0) == (j == 0) ? entry : -entry) / root;
    }
  }
  c.scaled_point = c.scaling * c.impulse;
  const double slip = tangential(c.speed);
  c.slip_gradient = slip > 0 ? Vector3(0, c.speed[1] / slip, c.speed[2] / slip) : Vector3::Zero();
  Matrix3 lifted = squared;
  lifted.row(0) -= c.slip_gradient.transpose() * squared;
  for (int i = 0; i < 3; ++i) lifted(i, i) += c.compliance[i];
  c.hessian = lifted.inverse();
}

/// Right side of a constraint's step towards the complementarity product `target`.
/// @param corrects  with the second-order term of the step before
void set_right_side(const Constraint& constraint, double target, bool corrects,
                    InteriorPointConstraint& c) {
  if (is_cone(constraint)) {
    Vector3 wanted = -product(c.scaled_point, c.scaled_point);
    wanted[0] += target;
    if (corrects) {
      wanted -=
          product(Vector3(c.inverse_scaling * c.speed_step), Vector3(c.scaling * c.impulse_step));
    }
    c.scaled_target = c.scaling * quotient(c.scaled_point, wanted);
    c.right_side = c.scaled_target - c.residual;
    c.right_side[0] -= c.slip_gradient.dot(c.scaled_target);
    return;
  }
  c.right_side[0] = -c.residual[0];
  if (c.lower_dual > 0) c.right_side[0] += target / (c.impulse[0] - c.lower);
  if (c.upper_dual > 0) c.right_side[0] -= target / (c.upper - c.impulse[0]);
}

/// Advances the speed of a cone. |u_t| is convex and grows by at least its derivative. The surplus
/// is added to the speed's first part at once, which leads deeper into the cone. As a residual it
/// stopped the method in heaps with impacts.
void advance_cone_speed(double step_length, InteriorPointConstraint& c) {
  const double slip = tangential(c.speed), told = c.slip_gradient.dot(c.speed_step);
  c.speed += step_length * c.speed_step;
  c.speed[0] += std::max(0.0, tangential(c.speed) - slip - step_length * told);
}

}  // namespace

/// Puts impulses and speeds inside their bounds.
/// @param margin  [m/s]
void VelocitySolver::enter_cones(const Problem& problem, double margin) {
  interior_.assign(problem.constraints.size(), InteriorPointConstraint{});
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& constraint = problem.constraints[k];
    InteriorPointConstraint& c = interior_[k];
    if (acting_rows(constraint) == 0) continue;
    double u[Constraint::most_rows];
    problem.constraint_velocity(constraint, u);
    if (is_cone(constraint)) {
      const double mu = cone_slope(constraint, u);
      c.scale = Vector3(1 / mu, 1, 1);
      const Vector3 mobility(constraint.mobility[0], constraint.mobility[1],
                             constraint.mobility[2]);
      c.compliance = compliance * mobility.cwiseProduct(c.scale).cwiseProduct(c.scale);
      c.impulse = Vector3(constraint.impulse[0] * mu, constraint.impulse[1], constraint.impulse[2]);
      c.reference_impulse = c.impulse;
      c.speed = Vector3((u[0] - constraint.target_velocity[0]) / mu,
                        u[1] - constraint.target_velocity[1], u[2] - constraint.target_velocity[2]);
      c.speed[0] = std::max(c.speed[0], 0.0) + tangential(c.speed) + margin / mu;
      c.impulse[0] =
          std::max(c.impulse[0], tangential(c.impulse)) + mu * margin / constraint.mobility[0];
      continue;
    }
    // An impulse between bounds; speeds beyond the one sought belong to the bounds.
    const double inside = margin / constraint.mobility[0];
    const double lower = constraint.lower, upper = constraint.upper;
    const double room = std::min(inside, (upper - lower) / 4);
    c.lower = lower, c.upper = upper;
    c.scale = Vector3(1, 0, 0);
    c.compliance = Vector3(compliance * constraint.mobility[0], 0, 0);
    c.reference_impulse = Vector3(constraint.impulse[0], 0, 0);
    c.impulse = Vector3(std::clamp(constraint.impulse[0], lower + room, upper - room), 0, 0);
    const double over = u[0] - constraint.target_velocity[0];
    c.lower_dual = lower == -HUGE_VAL ? 0 : std::max(over, 0.0) + margin;
    c.upper_dual = upper == HUGE_VAL ? 0 : std::max(-over, 0.0) + margin;
  }
}

/// Linearises all constraints, with the matrix and the residuals.
/// @return  the mean product of impulse and speed [J]
double VelocitySolver::linearise_interior_point(Problem& problem) {
  assemble_mass(problem, matrix_);
  double products = 0;
  int count = 0;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& constraint = problem.constraints[k];
    InteriorPointConstraint& c = interior_[k];
    LinearisedLaw& linear = laws_[k];
    const int rows = constraint.rows, solved = solved_rows(constraint);
    linear.is_zero = solved == 0;
    if (linear.is_zero) continue;
    double u[Constraint::most_rows];
    problem.constraint_velocity(constraint, u);
    const double over = c.scale[0] * (u[0] - constraint.target_velocity[0]);
    if (solved == 3) {
      scale_cone(c);
      c.residual = Vector3(over + tangential(c.speed), u[1] - constraint.target_velocity[1],
                           u[2] - constraint.target_velocity[2]) +
                   c.compliance.cwiseProduct(c.impulse - c.reference_impulse) - c.speed;
      products += c.impulse.dot(c.speed);
      ++count;
    } else {
      double stiffness = c.compliance[0];
      if (c.lower_dual > 0) {
        const double room = c.impulse[0] - c.lower;
        stiffness += c.lower_dual / room, products += c.lower_dual * room, ++count;
      }
      if (c.upper_dual > 0) {
        const double room = c.upper - c.impulse[0];
        stiffness += c.upper_dual / room, products += c.upper_dual * room, ++count;
      }
      c.hessian(0, 0) = 1 / stiffness;
      c.residual[0] = over + c.compliance[0] * (c.impulse[0] - c.reference_impulse[0]);
    }
    std::fill_n(linear.hessian.begin(), rows * rows, 0.0);
    for (int r = 0; r < solved; ++r) {
      for (int s = 0; s < solved; ++s) {
        linear.hessian[r * rows + s] = c.scale[r] * c.hessian(r, s) * c.scale[s];
      }
    }
    add_constraint_hessian(problem, constraint, linear, hessian_jacobian_, matrix_);
  }
  return products / std::max(1, count);
}

/// The direction to products of `target`, in direction_ and the constraints' changes.
/// @param corrects  whether the changes of the direction before are taken into account
/// @return          how far it goes before one of the impulses or speeds leaves its bounds
double VelocitySolver::interior_point_direction(Problem& problem, double target, bool corrects) {
  direction_ = residual_;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& constraint = problem.constraints[k];
    InteriorPointConstraint& c = interior_[k];
    const int solved = solved_rows(constraint);
    if (solved == 0) continue;
    set_right_side(constraint, target, corrects, c);
    double g[Constraint::most_rows] = {};
    for (int r = 0; r < solved; ++r) {
      for (int s = 0; s < solved; ++s) {
        g[r] += c.scale[r] * c.hessian(r, s) * c.right_side[s];
      }
    }
    add_impulse(problem, constraint, g, direction_);
  }
  matrix_.solve(direction_.data());
  std::swap(problem.velocity, direction_);
  double step_length = 1;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& constraint = problem.constraints[k];
    InteriorPointConstraint& c = interior_[k];
    const int solved = solved_rows(constraint);
    if (solved == 0) continue;
    double u[Constraint::most_rows];
    problem.constraint_velocity(constraint, u);
    if (solved == 3) {
      c.impulse_step = c.hessian * (c.right_side - Vector3(c.scale[0] * u[0], u[1], u[2]));
      c.speed_step = c.scaled_target - c.scaling * Vector3(c.scaling * c.impulse_step);
      step_length = std::min({step_length, step_to_cone_boundary(c.impulse, c.impulse_step),
                              step_to_cone_boundary(c.speed, c.speed_step)});
      continue;
    }
    const double change = c.hessian(0, 0) * (c.right_side[0] - u[0]);
    c.impulse_step[0] = change;
    if (c.lower_dual > 0) {
      const double room = c.impulse[0] - c.lower;
      c.lower_dual_step = (target - c.lower_dual * change) / room - c.lower_dual;
      step_length = std::min({step_length, step_to_bound(room, change),
                              step_to_bound(c.lower_dual, c.lower_dual_step)});
    }
    if (c.upper_dual > 0) {
      const double room = c.upper - c.impulse[0];
      c.upper_dual_step = (target + c.upper_dual * change) / room - c.upper_dual;
      step_length = std::min({step_length, step_to_bound(room, -change),
                              step_to_bound(c.upper_dual, c.upper_dual_step)});
    }
  }
  std::swap(problem.velocity, direction_);
  return step_length;
}

/// The mean product after a part of the way.
double VelocitySolver::complementarity_after(const Problem& problem, double step_length) const {
  double products = 0;
  int count = 0;
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const InteriorPointConstraint& c = interior_[k];
    if (acting_rows(problem.constraints[k]) == 0) continue;
    if (is_cone(problem.constraints[k])) {
      products +=
          (c.impulse + step_length * c.impulse_step).dot(c.speed + step_length * c.speed_step),
          ++count;
      continue;
    }
    const double impulse = c.impulse[0] + step_length * c.impulse_step[0];
    if (c.lower_dual > 0) {
      products += (impulse - c.lower) * (c.lower_dual + step_length * c.lower_dual_step), ++count;
    }
    if (c.upper_dual > 0) {
      products += (c.upper - impulse) * (c.upper_dual + step_length * c.upper_dual_step), ++count;
    }
  }
  return products / std::max(1, count);
}

/// Goes along the direction.
void VelocitySolver::interior_point_step(Problem& problem, double step_length) {
  for (std::size_t i = 0; i < direction_.size(); ++i)
    problem.velocity[i] += step_length * direction_[i];
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    Constraint& constraint = problem.constraints[k];
    InteriorPointConstraint& c = interior_[k];
    const int solved = solved_rows(constraint);
    if (solved == 0) continue;
    c.impulse += step_length * c.impulse_step;
    if (solved == 3) advance_cone_speed(step_length, c);
    if (c.lower_dual > 0) c.lower_dual += step_length * c.lower_dual_step;
    if (c.upper_dual > 0) c.upper_dual += step_length * c.upper_dual_step;
    for (int r = 0; r < solved; ++r) constraint.impulse[r] = c.scale[r] * c.impulse[r];
  }
}

/// The method ends without success where some steps bring the law no nearer: complementarity falls
/// then, but to a point whose friction is not opposed to slip.
/// @return  whether the residual became small enough; otherwise the problem holds the best iterate
bool VelocitySolver::interior_point(Problem& problem, SolverResult& outcome) {
  constexpr int most_stalled = 8;
  constexpr double nearer = 0.9;  // times the best residual
  // From no impulses: those of the last substep may hold each other up to any size.
  for (Constraint& constraint : problem.constraints) {
    for (int r = 0; r < solved_rows(constraint); ++r) constraint.impulse[r] = 0;
  }
  double scale = 0, best = HUGE_VAL;
  compute_constraint_velocities(problem);
  current_residual(problem, scale);
  const double pushed = momentum_residual(problem, residual_);
  best_.save(problem);
  if (!(scale + pushed > 0)) return false;
  enter_cones(problem, std::max(0.1 * scale, pushed));
  for (int i = 0, stalled = 0; i < options.most_interior_point_steps && stalled < most_stalled;
       ++i) {
    ++outcome.interior_point_steps;
    momentum_residual(problem, residual_);
    const double product = linearise_interior_point(problem);
    if (!matrix_.factor()) break;
    const double straight = interior_point_direction(problem, 0, false);
    const double left = std::clamp(complementarity_after(problem, straight) / product, 0.0, 1.0);
    const double centering = std::max(left * left * left, least_centering);
    const double step_length =
        interior_point_direction(problem, centering * product, straight > 0.1);
    interior_point_step(problem, std::min(1.0, boundary_fraction * step_length));
    compute_constraint_velocities(problem);
    outcome.residual = current_residual(problem, scale);
    if (!std::isfinite(outcome.residual)) break;
    stalled = outcome.residual < nearer * best ? 0 : stalled + 1;
    if (outcome.residual < best) {
      best = outcome.residual;
      best_.save(problem);
    }
    if (outcome.residual <= options.absolute_tolerance + options.regularised_tolerance * scale)
      return true;
  }
  best_.restore(problem);
  outcome.residual = best;
  return false;
}

}  // namespace ziggurat::dynamics
