// SPDX-License-Identifier: MIT
#include "physics/multibody/free_motion.h"

#include <algorithm>
#include <cmath>

#include "physics/multibody/equations.h"
#include "physics/multibody/rotation.h"

namespace ziggurat::dynamics {
namespace {

constexpr double most_rotation = 0.05;     // of a Runge-Kutta step of a single body [rad]
constexpr int most_rotation_steps = 8000;  // of one substep, of a single body
constexpr int most_steps = 4000;           // of one substep, of the longest tree
constexpr double tolerance = 1e-7;         // of a Dormand-Prince step, relative
constexpr double most_bias_change = 3e-3;  // relative change of velocity by bias forces
constexpr double most_driven_bias_change =
    0.045;  // its square, of trees that servos hold, over a second [1/s]

using Quaternion4 = Eigen::Vector4d;  // w x y z

Quaternion4 quaternion_rate(const Quaternion4& q, const Vector3& omega) {
  return 0.5 * Quaternion4(-omega.x() * q[1] - omega.y() * q[2] - omega.z() * q[3],
                           omega.x() * q[0] + omega.y() * q[3] - omega.z() * q[2],
                           -omega.x() * q[3] + omega.y() * q[0] + omega.z() * q[1],
                           omega.x() * q[2] - omega.y() * q[1] + omega.z() * q[0]);
}

/// Angular velocity of a body in world axes from its angular momentum.
Vector3 angular_velocity_of(const Quaternion4& q, const Vector3& inertia, const Vector3& momentum) {
  const Matrix3 r = rotation_matrix(q.data());
  return r * (r.transpose() * momentum).cwiseQuotient(inertia);
}

bool has_equal_inertias(const Vector3& inertia) {
  const double most = inertia.maxCoeff();
  return most - inertia.minCoeff() <= 1e-12 * most;
}

/// Rotates a single body without torque: its angular momentum stays.
/// @param omega  in: at the beginning; out: at the end [rad/s]
/// @return       the number of steps
int integrate_rotation(double* place, const Vector3& inertia, double time_step, Vector3& omega) {
  Quaternion4 q(place[0], place[1], place[2], place[3]);
  const Matrix3 r = rotation_matrix(place);
  const Vector3 momentum = r * (r.transpose() * omega).cwiseProduct(inertia);
  int steps = 1;
  if (has_equal_inertias(inertia)) {
    const Quaternion turned =
        exponential(omega * time_step) * Quaternion(place[0], place[1], place[2], place[3]);
    q = Quaternion4(turned.w(), turned.x(), turned.y(), turned.z());
  } else {
    const double fastest = momentum.norm() / inertia.minCoeff();
    steps = static_cast<int>(std::clamp(std::ceil(fastest * time_step / most_rotation), 1.0,
                                        double(most_rotation_steps)));
    const double h = time_step / steps;
    for (int i = 0; i < steps; ++i) {
      const Quaternion4 k1 = quaternion_rate(q, angular_velocity_of(q, inertia, momentum));
      const Quaternion4 q2 = q + h / 2 * k1;
      const Quaternion4 k2 = quaternion_rate(q2, angular_velocity_of(q2, inertia, momentum));
      const Quaternion4 q3 = q + h / 2 * k2;
      const Quaternion4 k3 = quaternion_rate(q3, angular_velocity_of(q3, inertia, momentum));
      const Quaternion4 q4 = q + h * k3;
      const Quaternion4 k4 = quaternion_rate(q4, angular_velocity_of(q4, inertia, momentum));
      q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      q.normalize();
    }
    omega = angular_velocity_of(q, inertia, momentum);
  }
  q.normalize();
  std::copy_n(q.data(), 4, place);
  return steps;
}

int integrate_single_body(Tree& tree, double time_step) {
  const Link& link = tree.links[0];
  const Matrix3& r = tree.rotation[0];
  const Vector3 torque = r.transpose() * tree.external[0].moment;
  Vector3 omega(tree.v[0], tree.v[1], tree.v[2]);
  omega += r * (torque.cwiseQuotient(link.inertia) * time_step);
  const int steps = integrate_rotation(tree.q.data() + 3, link.inertia, time_step, omega);
  for (int k = 0; k < 3; ++k) {
    tree.v[k] = omega[k];
    tree.v[3 + k] += time_step * tree.external[0].force[k] / link.mass;
    tree.q[k] += time_step * (tree.v[3 + k] + time_step * tree.gravity[k] / 2);
    tree.v[3 + k] += time_step * tree.gravity[k];
  }
  forward_kinematics(tree);
  velocity_kinematics(tree);
  return steps;
}

/// dq/dt from v.
void position_rates(const Tree& tree, const double* q, const double* v, double* out) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const double* at = q + tree.first_position[i];
    const double* speed = v + tree.first_dof[i];
    double* rates = out + tree.first_position[i];
    switch (tree.links[i].joint) {
      case JointType::floating: {
        double all[6] = {};
        for (int k = 0, next = 0; k < 6; ++k) {
          if (tree.freedoms >> k & 1) all[k] = speed[next++];
        }
        const Quaternion4 turned = quaternion_rate(Quaternion4(at[3], at[4], at[5], at[6]),
                                                   Vector3(all[0], all[1], all[2]));
        std::copy_n(all + 3, 3, rates);
        std::copy_n(turned.data(), 4, rates + 3);
        break;
      }
      case JointType::fixed:
        break;
      case JointType::spherical: {  // q * (0, v) / 2: velocities are along the body's axes
        const double w = at[0], x = at[1], y = at[2], z = at[3];
        rates[0] = 0.5 * (-x * speed[0] - y * speed[1] - z * speed[2]);
        rates[1] = 0.5 * (w * speed[0] + y * speed[2] - z * speed[1]);
        rates[2] = 0.5 * (w * speed[1] + z * speed[0] - x * speed[2]);
        rates[3] = 0.5 * (w * speed[2] + x * speed[1] - y * speed[0]);
        break;
      }
      default:
        rates[0] = speed[0];
    }
  }
}

void normalise_quaternions(Tree& tree) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const JointType joint = tree.links[i].joint;
    if (joint != JointType::floating && joint != JointType::spherical) continue;
    double* q = tree.q.data() + tree.first_position[i] + (joint == JointType::floating ? 3 : 0);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; ++k) q[k] /= length;
  }
}

constexpr int stage_count = 7;
constexpr double weights[stage_count][6] = {
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
/// Fifth less fourth order.
constexpr double error_weights[stage_count] = {
    71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

/// One step of Dormand and Prince: stages in `k`, each the rates of q and v; the new state in the
/// tree.
/// @return  the estimated error relative to the tolerance
double dormand_prince_step(Tree& tree, Workspace& work, const PrescribedJoints& drive,
                           const double* start, double* k, double h) {
  const int positions = static_cast<int>(tree.q.size()), size = positions + tree.dofs;
  for (int stage = 1; stage < stage_count; ++stage) {
    for (int i = 0; i < size; ++i) {
      double sum = 0;
      for (int j = 0; j < stage; ++j) sum += weights[stage][j] * k[j * size + i];
      (i < positions ? tree.q[i] : tree.v[i - positions]) = start[i] + h * sum;
    }
    position_rates(tree, tree.q.data(), tree.v.data(), k + stage * size);
    forward_dynamics(tree, work, drive,
                     {k + stage * size + positions, static_cast<std::size_t>(tree.dofs)});
  }
  double speed = 0;  // scale of the error: the fastest coordinate
  for (int i = 0; i < tree.dofs; ++i) speed = std::max(speed, std::abs(tree.v[i]));
  double worst = 0;
  for (int i = 0; i < tree.dofs; ++i) {
    double error = 0, largest = 0;
    for (int j = 0; j < stage_count; ++j) {
      const double slope = k[j * size + positions + i];
      error += error_weights[j] * slope;
      largest = std::max(largest, std::abs(slope));
    }
    const double scale = 1e-9 + tolerance * (std::abs(tree.v[i]) + 0.1 * speed + h * largest);
    worst = std::max(worst, std::abs(h * error) / scale);
  }
  return worst;
}

/// Applies the impulse of external wrenches and of prescribed velocities.
void kick(Tree& tree, Workspace& work, double time_step, const PrescribedJoints& drive) {
  const auto acts = [](const Wrench& w) { return !w.moment.isZero(0) || !w.force.isZero(0); };
  if (drive.prescribed.empty() && std::none_of(tree.external.begin(), tree.external.end(), acts))
    return;
  compute_mass_matrix(tree, work);
  auto& change = work.scratch;
  external_forces(tree, work, change, true, false);
  for (double& impulse : change) impulse *= time_step;
  for (std::size_t k = 0; k < drive.prescribed.size(); ++k) {
    if (drive.prescribed[k]) change[k] = drive.velocity[k] - tree.v[k];
  }
  solve_prescribed(tree, work, drive, change);
  for (int i = 0; i < tree.dofs; ++i)
    tree.v[i] = drive.prescribes(i) ? drive.velocity[i] : tree.v[i] + change[i];
}

/// Largest number of steps in a substep: as many link updates as take some tenths of a second.
int most_steps_of(const Tree& tree) {
  constexpr int all = 800'000;
  return std::clamp(all / static_cast<int>(tree.links.size()), most_steps, 10 * most_steps);
}

int integrate_tree(Tree& tree, Workspace& work, double time_step, const PrescribedJoints& drive) {
  const int positions = static_cast<int>(tree.q.size()), size = positions + tree.dofs;
  work.stages.resize((stage_count + 1) * size);
  double* start = work.stages.data();
  double* k = start + size;
  kick(tree, work, time_step, drive);
  if (!drive.prescribed.empty() &&
      std::ranges::all_of(drive.prescribed, [](unsigned char held) { return held != 0; })) {
    std::copy(tree.v.begin(), tree.v.end(), work.scratch.begin());
    for (double& step : work.scratch) step *= time_step;
    integrate_positions(tree, work.scratch);
    forward_kinematics(tree);
    velocity_kinematics(tree);
    return 1;
  }
  std::copy(tree.q.begin(), tree.q.end(), start);
  std::copy(tree.v.begin(), tree.v.end(), start + positions);
  position_rates(tree, tree.q.data(), tree.v.data(), k);
  forward_dynamics(tree, work, drive, {k + positions, static_cast<std::size_t>(tree.dofs)});
  double done = 0,
         h = std::min(time_step, tree.integrator_step > 0 ? tree.integrator_step : time_step);
  const int most = most_steps_of(tree);
  int steps = 0;
  while (done < time_step && steps < most) {
    ++steps;
    const bool last = done + h >= time_step * (1 - 1e-12);
    if (last) h = time_step - done;
    const double error = dormand_prince_step(tree, work, drive, start, k, h);
    const double factor = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 4.0);
    if (error > 1 && steps < most / 2) {
      h *= factor;
      std::copy_n(start, positions, tree.q.begin());
      std::copy_n(start + positions, tree.dofs, tree.v.begin());
      continue;
    }
    normalise_quaternions(tree);
    std::copy(tree.q.begin(), tree.q.end(), start);
    std::copy(tree.v.begin(), tree.v.end(), start + positions);
    std::copy_n(k + (stage_count - 1) * size, size, k);  // its last stage is the next one's first
    tree.integrator_step = h * factor;
    done = last ? time_step : done + h;
    h *= factor;
  }
  work.ran_out_of_steps |= done < time_step;
  forward_kinematics(tree);
  velocity_kinematics(tree);
  return steps;
}

/// Momentum of the velocity after free motion, with the mass matrix before it.
void momentum_by_free_motion(Tree& tree, Workspace& work, double time_step, std::span<double> out) {
  const int n = tree.dofs;
  work.saved_state.assign(tree.q.begin(), tree.q.end());
  work.saved_state.insert(work.saved_state.end(), tree.v.begin(), tree.v.end());
  integrate_tree(tree, work, time_step, {});
  std::copy(tree.v.begin(), tree.v.end(), work.stages.begin());
  std::copy_n(work.saved_state.begin(), tree.q.size(), tree.q.begin());
  std::copy_n(work.saved_state.begin() + static_cast<std::ptrdiff_t>(tree.q.size()), n,
              tree.v.begin());
  forward_kinematics(tree);
  velocity_kinematics(tree);
  compute_mass_matrix(tree, work);
  for (int i = 0; i < n; ++i) {
    out[i] = 0;
    for (int j = 0; j < n; ++j) {
      // Damping of joints is implicit in the final velocity; see problem.h.
      out[i] += work.mass[i * n + j] * work.stages[j];
    }
    out[i] += time_step * tree.damping[i] * work.stages[i];
  }
}

}  // namespace

void kick(Tree& tree, Workspace& work, double time_step) {
  kick(tree, work, time_step, {});
  velocity_kinematics(tree);
}

int integrate_free_motion(Tree& tree, Workspace& work, double time_step,
                          const PrescribedJoints& drive) {
  if (tree.is_single_body) return integrate_single_body(tree, time_step);
  return tree.dofs > 0 ? integrate_tree(tree, work, time_step, drive) : 0;
}

namespace {

/// Angular velocity of a single body after a substep of torque-free rotation.
void rotate_freely(const Tree& tree, double time_step, Vector3& omega) {
  const Vector3& inertia = tree.links[0].inertia;
  if (omega.norm() * time_step > most_bias_change) {
    double place[4];
    std::copy_n(tree.q.data() + 3, 4, place);
    integrate_rotation(place, inertia, time_step, omega);
    return;
  }
  // Midpoint rule in the body's axes, with an error of order 3 in the angle. The axes rotate, too.
  const Matrix3& r = tree.rotation[0];
  const auto change = [&](const Vector3& w) -> Vector3 {
    return w.cwiseProduct(inertia).cross(w).cwiseQuotient(inertia);
  };
  const Vector3 w = r.transpose() * omega;
  const Vector3 middle = w + time_step / 2 * change(w);
  const Vector3 turned = w + time_step * change(middle);
  const Vector3 angle = time_step * middle;
  omega = r * (turned + angle.cross(turned) + angle.cross(angle.cross(turned)) / 2);
}

void momentum_of_body(const Tree& tree, Workspace& work, double time_step, std::span<double> out) {
  const Link& link = tree.links[0];
  const Matrix3& r = tree.rotation[0];
  Vector3 omega(tree.v[0], tree.v[1], tree.v[2]);
  const Vector3 torque = r.transpose() * tree.external[0].moment;
  omega += r * (torque.cwiseQuotient(link.inertia) * time_step);
  Vector3 momentum = r * (r.transpose() * omega).cwiseProduct(link.inertia);
  work.root_bias_impulse.fill(0);
  work.bias_velocity_change = 0;
  if (!has_equal_inertias(link.inertia)) {
    rotate_freely(tree, time_step, omega);
    const Vector3 flown = r * (r.transpose() * omega).cwiseProduct(link.inertia);
    for (int k = 0; k < 3; ++k) work.root_bias_impulse[k] = momentum[k] - flown[k];
    const double size = momentum.squaredNorm();
    work.bias_velocity_change = size > 0 ? std::sqrt((flown - momentum).squaredNorm() / size) : 0;
    momentum = flown;
  }
  for (int k = 0; k < 3; ++k) {
    out[k] = momentum[k];
    out[3 + k] = link.mass * (tree.v[3 + k] + time_step * tree.gravity[k]) +
                 time_step * tree.external[0].force[k];
  }
}

/// Whether external wrenches act on a tree.
bool has_fields(const Tree& tree) {
  return std::ranges::any_of(tree.external, [](const Wrench& wrench) {
    return !(wrench.moment.cwiseAbs().sum() + wrench.force.cwiseAbs().sum() == 0);
  });
}

}  // namespace

void predict_momentum(Tree& tree, Workspace& work, double time_step, bool driven,
                      std::span<double> out) {
  if (tree.is_single_body) return momentum_of_body(tree, work, time_step, out);
  const int n = tree.dofs;
  // Bias forces do no work, but an explicit step of them adds energy of second order in the
  // relative change of velocity. Where that matters the substep is a free motion.
  bias_forces(tree, work, work.scratch);
  if (has_fields(tree)) {
    external_forces(tree, work, out, true, true);
  } else {
    gravity_forces(tree, work, out);
  }
  double energy = 0, change = 0;
  for (int i = 0; i < n; ++i) {
    const double momentum = work.momentum[i];
    out[i] = momentum + time_step * out[i];
    energy += momentum * tree.v[i];
    change += time_step * time_step * work.scratch[i] * work.scratch[i] / work.mass[i * n + i];
  }
  const int root = std::min(6, n);
  std::copy_n(out.begin(), root, work.root_bias_impulse.begin());
  work.bias_velocity_change = energy > 0 ? std::sqrt(change / energy) : 0;
  if (work.bias_velocity_change >
      (driven ? std::max(most_bias_change, std::sqrt(most_driven_bias_change * time_step))
              : most_bias_change)) {
    momentum_by_free_motion(tree, work, time_step, out);
  } else {
    for (int i = 0; i < n; ++i) out[i] -= time_step * work.scratch[i];
  }
  for (int i = 0; i < root; ++i) work.root_bias_impulse[i] -= out[i];
}

}  // namespace ziggurat::dynamics
