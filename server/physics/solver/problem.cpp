// SPDX-License-Identifier: MIT
#include "physics/solver/problem.h"

#include <algorithm>
#include <cmath>

#include "physics/multibody/free_motion.h"

namespace ziggurat::dynamics {
namespace {

/// Largest penetration under load, and largest push-out in a substep [m].
constexpr double most_penetration = 1e-7;

/// Largest motion of a contact along its normal, by a unit of a coordinate, that counts as
/// tangential [1], [m].
constexpr double tangential_mobility = 1e-9;

/// A right-handed frame whose first column is the normal.
Matrix3 frame_about(const Vector3& normal) {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
  }
  Matrix3 frame;
  frame.col(0) = normal;
  frame.col(1) = normal.cross(Vector3::Unit(least)).normalized();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

/// Whether a limit's lower bound is the active one: the bound that the joint's velocity passes
/// within the substep, or else the nearer one.
bool reaches_lower_bound(const Limit& limit, double q, double speed, double time_step) {
  const double end = q + time_step * speed;
  if (end < limit.lower || end > limit.upper) return end < limit.lower;
  return q - limit.lower < limit.upper - q;
}

/// Whether any coordinate moves the sides of a contact along its normal.
bool has_normal_mobility(const Problem& problem, const Constraint& constraint) {
  const auto moves = [&](int index, int first, std::span<const int> dofs) {
    if (index < 0) return false;
    if (problem.trees[index]->has_floating_base) return true;
    const auto normal = std::span(problem.jacobian).subspan(first, dofs.size());
    return std::ranges::any_of(normal,
                               [](double entry) { return std::abs(entry) > tangential_mobility; });
  };
  return moves(constraint.a, constraint.jacobian_a, constraint.dofs_a) ||
         moves(constraint.b, constraint.jacobian_b, constraint.dofs_b);
}

/// Whether a link rotates enough that the paths of its points are curved.
bool rotates(const Tree& tree, double time_step) {
  constexpr double least = 1e-6;  // [rad]
  return std::ranges::any_of(tree.spatial_velocity, [&](const Motion& motion) {
    return motion.angular.squaredNorm() * time_step * time_step > least * least;
  });
}

/// Whether a link rotates so far in a substep that velocities do not tell the final positions of
/// its points.
bool rotates_far(const Motion& motion, double time_step) {
  constexpr double most = 0.2;  // [rad]
  return motion.angular.squaredNorm() * time_step * time_step > most * most;
}

}  // namespace

void Problem::clear() {
  trees.clear();
  offset.clear();
  mass.clear();
  mass_offset.clear();
  root_bias_impulse.clear();
  bias_velocity_change.clear();
  constraints.clear();
  jacobian_end = 0;
  momentum.clear();
  inverse_mass.clear();
  total_mass.clear();
  weight = 0;
  bias_acceleration.clear();
  first_bias_acceleration.clear();
  velocity.clear();
  couplings.clear();
}

void Problem::add(Tree& tree, Workspace& work, bool is_driven) {
  const int first = static_cast<int>(momentum.size());
  trees.push_back(&tree);
  offset.push_back(first);
  momentum.resize(first + tree.dofs);
  compute_mass_matrix(tree, work);
  predict_momentum(tree, work, time_step, is_driven,
                   {momentum.data() + first, static_cast<std::size_t>(tree.dofs)});
  inverse_mass.resize(momentum.size());
  for (int k = 0; k < tree.dofs; ++k) inverse_mass[first + k] = 1 / work.mass[k * tree.dofs + k];
  first_bias_acceleration.push_back(-1);
  if (has_several_trees && rotates(tree, time_step)) {
    first_bias_acceleration.back() = static_cast<int>(bias_acceleration.size());
    bias_accelerations(tree, work);
    bias_acceleration.insert(bias_acceleration.end(), work.acceleration.begin(),
                             work.acceleration.end());
  }
  double total = 0;
  for (const Link& link : tree.links) total += link.mass;
  total_mass.push_back(total);
  weight += total * tree.gravity.norm();
  mass_offset.push_back(static_cast<int>(mass.size()));
  mass.insert(mass.end(), work.mass.begin(), work.mass.end());
  root_bias_impulse.push_back(work.root_bias_impulse);
  bias_velocity_change.push_back(work.bias_velocity_change);
  velocity.insert(velocity.end(), tree.v.begin(), tree.v.end());
}

/// Adds rows for some dofs, to be set.
/// @param first  out: where they begin in the Jacobian
double* Problem::add_rows(int rows, std::size_t dofs, int& first) {
  first = static_cast<int>(jacobian_end);
  jacobian_end += dofs * rows;
  if (jacobian.size() < jacobian_end) jacobian.resize(2 * jacobian_end);
  return jacobian.data() + first;
}

namespace {

/// Makes mobilities equal for the rows of a friction disc, and more than 0.
void finish_mobility(Constraint& constraint) {
  constexpr double least = 1e-12;
  std::array<double, Constraint::most_rows>& mobility = constraint.mobility;
  for (const FrictionDisc& disc : discs_of(constraint.rows)) {
    double &first = mobility[disc.first], &last = mobility[disc.first + disc.size - 1];
    first = last = (first + last) / 2;
  }
  for (int r = 0; r < constraint.rows; ++r) mobility[r] = std::max(mobility[r], least);
}

}  // namespace

/// Sets the mobility of a constraint of one row on one tree.
void Problem::set_row_mobility(Constraint& constraint) const {
  const double *row = jacobian.data() + constraint.jacobian_a,
               *inverse = inverse_mass.data() + offset[constraint.a];
  for (const int k : constraint.dofs_a) {
    constraint.mobility[0] += *row * *row * inverse[k];
    ++row;
  }
}

/// Bias acceleration of a link at a point of contact, at dv/dt = 0 [m/s^2].
/// @param tree  its index in the island
Vector3 Problem::point_bias_acceleration(int tree, int link, const Vector3& point,
                                         const ContactPoint& contact) const {
  const Motion& motion = trees[tree]->spatial_velocity[link];
  if (first_bias_acceleration[tree] < 0 ||
      (rotates_far(motion, time_step) && !contact.has_point_velocity))
    return Vector3::Zero();
  const Motion& spatial = bias_acceleration[first_bias_acceleration[tree] + link];
  const Vector3 arm = point - trees[tree]->origin;
  const Vector3 with_it = motion.linear + motion.angular.cross(arm);
  return spatial.linear + spatial.angular.cross(arm) +
         motion.angular.cross(contact.has_point_velocity ? contact.point_velocity : with_it);
}

/// Sets the target velocity and compliance of a contact without restitution. Touching surfaces are
/// stiff springs, equal for all points of a pair. So redundant contacts share a load by their
/// penetration; rigid ones share it by their history.
void Problem::set_normal_target(Constraint& constraint, const ContactPoint& contact) const {
  constraint.target_velocity[0] = -constraint.gap / time_step;
  if (compliance_factor == 0) {
    constraint.target_velocity[0] = std::min(0.0, constraint.target_velocity[0]);
    return;
  }
  const auto inverse = [&](int index) { return index >= 0 ? 1 / total_mass[index] : 0; };
  constraint.target_velocity[0] =
      std::min(most_penetration / time_step, constraint.target_velocity[0]);
  if (constraint.gap > 0 && !contact.carried) return;  // an impact is stopped at the surface
  constraint.compliance = compliance_factor * (inverse(constraint.a) + inverse(constraint.b));
  if (weight > 0)
    constraint.compliance =
        std::min(constraint.compliance, most_penetration / (time_step * time_step * weight));
}

/// Adds half of the gap's second derivative at constant joint velocities to the target velocity,
/// where both sides rotate: touching points stay together to second order. The normal turns with
/// the side whose face it is, or with both.
void Problem::add_rotation_correction(Constraint& constraint, const ContactPoint& contact) const {
  if (first_bias_acceleration[constraint.a] < 0 && first_bias_acceleration[constraint.b] < 0)
    return;
  const LinkIndex sides[] = {contact.a, contact.b};
  const Vector3 points[] = {contact.point, contact.point + contact.offset_to_b};
  const int indices[] = {constraint.a, constraint.b};
  Vector3 faster = Vector3::Zero(), speed = Vector3::Zero(),
          turning = Vector3::Zero();  // of a less b; of both
  for (int i = 0; i < 2; ++i) {
    const Tree& tree = *trees[indices[i]];
    const Motion& motion = tree.spatial_velocity[sides[i].link];
    const double sign = i == 0 ? 1 : -1;
    faster += sign * point_bias_acceleration(indices[i], sides[i].link, points[i], contact);
    speed += sign * (motion.linear + motion.angular.cross(points[i] - tree.origin));
    turning += motion.angular;
  }
  for (int r = 1; r < std::min(constraint.rows, 3); ++r)
    constraint.target_velocity[r] = -time_step / 2 * constraint.frame.col(r).dot(faster);
  const auto far = [&](int i) {
    return rotates_far(trees[indices[i]]->spatial_velocity[sides[i].link], time_step);
  };
  const bool rebounds = contact.restitution > 0;  // its impact ends the step
  if (rebounds || (!contact.has_point_velocity && (far(0) || far(1)))) return;
  const Vector3 normal = constraint.frame.col(0);
  const Vector3 normal_turns = contact.has_point_velocity
                                   ? contact.face_angular_velocity.cross(normal)
                                   : Vector3(turning.cross(normal));
  constraint.gap_acceleration = normal.dot(faster) + normal_turns.dot(speed);
  const double alone = std::max(0.0, constraint.target_velocity[0]);
  constraint.target_velocity[0] -= time_step / 2 * constraint.gap_acceleration;
  if (!contact.carried && !contact.has_point_velocity)
    constraint.target_velocity[0] =
        std::min(constraint.target_velocity[0], alone);  // the face of an impact is unknown
}

void Problem::add(const ContactPoint& contact, int a, int b, int source) {
  Constraint& constraint = constraints.emplace_back();
  set_law(contact, constraint);
  constraint.a = a;
  constraint.b = b;
  const Constraint* other = constraints.size() > 1 ? &constraints[constraints.size() - 2] : nullptr;
  const bool same = other && other->frame.col(0) == contact.normal;
  constraint.frame = same ? other->frame : frame_about(contact.normal);
  if (a >= 0) add_contact_rows(*trees[a], contact.a.link, contact.point, constraint, 1);
  if (b >= 0) {
    add_contact_rows(*trees[b], contact.b.link, contact.point + contact.offset_to_b, constraint,
                     -1);
  }
  finish_mobility(constraint);
  constraint.source = source;
  constraint.gap = contact.gap;
  if (!has_normal_mobility(
          *this,
          constraint)) {  // without normal mobility any normal impulse is a solution: it is zero
    constraint.law = Constraint::Law::off;
    return;
  }
  for (int r = 0; r < constraint.rows; ++r)
    constraint.impulse[r] =
        constraint.frame.col(r % 3).dot(r < 3 ? contact.impulse : contact.angular_impulse);
  constraint.impulse[0] = std::max(0.0, constraint.impulse[0]);
  set_normal_target(constraint, contact);
  if (a >= 0 && b >= 0) add_rotation_correction(constraint, contact);
  constraint.restitution = contact.restitution;
  if (a >= 0 && b >= 0 && a != b) add_coupling(a, b);
}

void Problem::add_coupling(int a, int b) {
  const std::pair<int, int> pair(std::min(a, b), std::max(a, b));
  if (couplings.empty() || couplings.back() != pair) couplings.push_back(pair);
}

/// Adds the rows of a servo between two trees.
void Problem::add_grip_rows(const Servo& servo, int other, Constraint& constraint) {
  constraint.b = other;
  constraint.frame = frame_about(servo.direction.linear);
  add_contact_rows(*trees[constraint.a], servo.link, servo.point, constraint, 1);
  add_contact_rows(*trees[other], servo.other.link, servo.point, constraint, -1);
  add_coupling(constraint.a, other);
  if (!has_normal_mobility(*this, constraint)) constraint.law = Constraint::Law::off;
}

void Problem::add(const Servo& servo, int index, int other, int source) {
  const Tree& tree = *trees[index];
  Constraint& constraint = constraints.emplace_back();
  set_law(servo, constraint);
  constraint.a = index;
  constraint.source = source;
  if (other >= 0) {
    add_grip_rows(servo, other, constraint);
  } else {
    constraint.dofs_a = servo.dof >= 0 ? tree.dof_span(servo.dof) : tree.dofs_of(servo.link);
    double* row = add_rows(1, constraint.dofs_a.size(), constraint.jacobian_a);
    if (servo.dof >= 0) {
      *row = 1;
    } else {
      const Vector3 arm = tree.position[servo.link] - tree.origin;
      for (const int k : constraint.dofs_a) {
        const Motion& axis = tree.motion_subspace[k];
        *row++ = servo.direction.angular.dot(axis.angular) +
                 servo.direction.linear.dot(axis.linear + axis.angular.cross(arm));
      }
    }
    set_row_mobility(constraint);
  }
  finish_mobility(constraint);
  if (constraint.law == Constraint::Law::off) return;
  constraint.target_velocity[0] = servo.target_velocity;
  constraint.impulse[0] = std::clamp(servo.impulse, servo.lower, servo.upper);
}

void Problem::add(const Limit& limit, int index, int source) {
  const Tree& tree = *trees[index];
  const int dof = joint_dof(tree, limit.link);
  const double q = tree.q[tree.first_position[limit.link]];
  const bool at_lower = reaches_lower_bound(limit, q, tree.v[dof], time_step);
  Constraint& constraint = constraints.emplace_back();
  set_law(limit, constraint);
  constraint.a = index;
  *add_rows(1, 1, constraint.jacobian_a) = at_lower ? 1 : -1;
  constraint.dofs_a = tree.dof_span(dof);
  set_row_mobility(constraint);
  finish_mobility(constraint);
  constraint.gap = at_lower ? q - limit.lower : limit.upper - q;
  constraint.range = limit.upper - limit.lower;
  constraint.target_velocity[0] = constraint.gap > 0 ? -constraint.gap / time_step : 0;
  constraint.impulse[0] = std::max(0.0, at_lower ? limit.impulse : -limit.impulse);
  constraint.source = source;
}

bool Problem::switch_limits() {
  constexpr double rounding = 1e-9;  // [m], [rad]
  bool any = false;
  for (Constraint& constraint : constraints) {
    if (constraint.kind != Constraint::Kind::limit) continue;
    double speed = 0;
    constraint_velocity(constraint, &speed);
    if (constraint.gap + time_step * speed <= constraint.range + rounding) continue;
    double& direction = jacobian[constraint.jacobian_a];
    direction = -direction;
    constraint.gap = constraint.range - constraint.gap;
    constraint.target_velocity[0] = -std::max(0.0, constraint.gap) / time_step;
    constraint.impulse[0] = 0;
    any = true;
  }
  return any;
}

void Problem::bound_penetration() {
  double depth = 0;
  for (const Constraint& constraint : constraints)
    depth = std::max(depth, constraint.compliance * constraint.impulse[0] * time_step);
  if (depth <= most_penetration) return;
  for (Constraint& constraint : constraints) constraint.compliance *= most_penetration / depth;
}

void Problem::settle_loads() {
  constexpr double least = 1e-4;  // of the depth that the island's weight presses in
  for (Constraint& constraint : constraints) {
    if (constraint.compliance == 0 || constraint.gap_acceleration != 0) continue;
    const double pressed_in = constraint.compliance * constraint.impulse[0];
    const double deepest = constraint.compliance * time_step * weight;
    if (std::abs(constraint.gap / time_step + pressed_in) < least * deepest)
      constraint.target_velocity[0] = pressed_in;
  }
}

void Problem::make_rigid() {
  for (Constraint& constraint : constraints) {
    if (constraint.compliance == 0) continue;
    constraint.compliance = 0;
    constraint.target_velocity[0] =
        std::min(0.0, constraint.target_velocity[0] + time_step / 2 * constraint.gap_acceleration) -
        time_step / 2 * constraint.gap_acceleration;
  }
}

double Problem::gap_after(const Constraint& constraint) const {
  double u[Constraint::most_rows];
  constraint_velocity(constraint, u);
  return constraint.gap + time_step * (u[0] + time_step / 2 * constraint.gap_acceleration);
}

bool Problem::leaves_trees_penetrating() const {
  return std::ranges::any_of(constraints, [&](const Constraint& constraint) {
    return constraint.a >= 0 && constraint.b >= 0 && penetrates(constraint) &&
           gap_after(constraint) < -allowed_overlap;
  });
}

bool Problem::become_displacement() {
  if (std::ranges::none_of(constraints,
                           [&](const Constraint& constraint) { return penetrates(constraint); }))
    return false;
  for (Constraint& constraint : constraints) {
    if (constraint.law == Constraint::Law::off) continue;
    if (constraint.kind == Constraint::Kind::servo) {
      constraint.law = Constraint::Law::off;
      constraint.impulse.fill(0);  // Gauss-Seidel starts from all impulses
      continue;
    }
    const double after = gap_after(constraint);
    constraint.law = Constraint::Law::bounded;
    // four fifths of a penetration are resolved per substep; the last micrometre stays
    constraint.target_velocity[0] =
        constraint.gap < 0 ? -0.8 * std::min(0.0, after + allowed_overlap) : -after;
    constraint.compliance = 0;
    constraint.impulse.fill(0);
  }
  std::fill(momentum.begin(), momentum.end(), 0.0);
  std::fill(velocity.begin(), velocity.end(), 0.0);
  return true;
}

}  // namespace ziggurat::dynamics
