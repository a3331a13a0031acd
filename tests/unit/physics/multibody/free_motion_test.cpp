// SPDX-License-Identifier: MIT
// Motion without contacts against closed forms and conserved quantities.

#include "physics/multibody/free_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../long_runs.h"
#include "../stepping/trees.h"

namespace ziggurat::dynamics {
namespace {

using testing::g;

Vector3 angular_momentum(const Tree& tree) {
  const Matrix3& r = tree.rotation[0];
  const Vector3 omega = r.transpose() * tree.spatial_velocity[0].angular;
  return r * omega.cwiseProduct(tree.links[0].inertia);
}

// Articulated bodies give what the mass matrix gives: M dv/dt = f - c, or no change where a servo
// prescribes a speed.
void expect_consistent(Tree& tree) {
  Workspace work;
  tree.gravity = Vector3(0, 1, -testing::g);
  for (int k = 0; k < tree.dofs; ++k) tree.v[k] = 0.3 + 0.1 * k;
  const int n = tree.dofs;
  std::vector<unsigned char> prescribed(n, 0);
  std::vector<double> velocity(n, 0.0), force(n, 0.0), forces(n), weights(n), acceleration(n);
  for (const bool is_driven : {false, true}) {
    prescribed[n - 1] = is_driven;
    force[n - 2] = is_driven ? 0.3 : 0;
    const PrescribedJoints drive{prescribed, velocity, force};
    forward_dynamics(tree, work, drive, acceleration);
    compute_mass_matrix(tree, work);
    external_forces(tree, work, forces, false, true);
    gravity_forces(tree, work, weights);
    bias_forces(tree, work, work.scratch);
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(weights[i], forces[i], 1e-12) << i;
      double momentum = 0;
      for (int j = 0; j < n; ++j) momentum += work.mass[i * n + j] * tree.v[j];
      EXPECT_NEAR(work.momentum[i], momentum, 1e-12) << i;
      if (prescribed[i]) {
        EXPECT_EQ(acceleration[i], 0) << i;
        continue;
      }
      double sum = forces[i] - work.scratch[i] + force[i] - tree.damping[i] * tree.v[i];
      for (int j = 0; j < n; ++j) sum -= work.mass[i * n + j] * acceleration[j];
      EXPECT_NEAR(sum, 0, 1e-9) << i;
    }
  }
}

TEST(ForwardDynamics, IsThatOfTheMassMatrix) {
  const Link rod = testing::box_link({0.2, 0.1, 0.05}, 0.7);
  const Vector3 end(0.1, 0.02, 0), middle(0.1, 0, 0.01);
  Tree tree({testing::box_link({0.3, 0.2, 0.1}, 2),
             testing::hung(rod, 0, JointType::spherical, Vector3::UnitZ(), end, middle),
             testing::hung(rod, 1, JointType::revolute, Vector3(0, 0.6, 0.8), end, middle),
             testing::hung(rod, 0, JointType::prismatic, Vector3::UnitZ(), -end, middle)},
            {{0.1, 0.2, 0.3}, Quaternion(0.5, 0.1, 0.7, 0.2).normalized()});
  EXPECT_EQ(tree.gyrostat, nullptr);
  expect_consistent(tree);
}

// Two wheels of which each has equal moments of inertia across its axis, on tilted axes.
TEST(ForwardDynamics, OfAGyrostatIsThatOfTheMassMatrix) {
  const Link wheel = testing::box_link({0.2, 0.2, 0.05}, 0.7);
  Link tilted = testing::hung(wheel, 0, JointType::revolute, Vector3::UnitZ(), {0.1, 0.2, 0.05},
                              {0, 0, 0.03});
  tilted.joint_in_parent.orientation = Quaternion(0.9, 0.1, -0.3, 0.2).normalized();
  Tree tree(
      {testing::box_link({0.3, 0.2, 0.1}, 2),
       testing::hung(wheel, 0, JointType::revolute, Vector3::UnitZ(), {-0.1, 0.02, 0}, {0, 0, 0}),
       tilted},
      {{0.1, 0.2, 0.3}, Quaternion(0.5, 0.1, 0.7, 0.2).normalized()});
  tree.q[7] = 0.4;
  tree.q[8] = -1.3;
  ASSERT_NE(tree.gyrostat, nullptr);
  expect_consistent(tree);
}

// Euler's equation: the inertia's axes rotate with the body, so at the mass matrix of the beginning
// its momentum becomes L - h w x L. The torque holds a body that rolls in a circle, at any substep.
TEST(FreeMotion, GyroscopicTorquesActInSubstepsOfAnyLength) {
  Workspace work;
  Tree body = testing::box({0.1, 0.2, 0.3}, 2,
                           {Vector3::Zero(), Quaternion(0.5, 0.1, 0.7, 0.2).normalized()});
  body.v = {0.7, -0.4, 0.9, 0, 0, 0};
  velocity_kinematics(body);
  const Vector3 omega(0.7, -0.4, 0.9), before = angular_momentum(body);
  for (const double hz : {50., 200., 500., 1000., 2000., 1e4, 1e6}) {
    double after[6];
    compute_mass_matrix(body, work);
    predict_momentum(body, work, 1 / hz, false, after);
    const Vector3 torque = hz * (Vector3(after[0], after[1], after[2]) - before);
    const Vector3 exact = -omega.cross(before);
    EXPECT_LT((torque - exact).norm(), 2 / hz * omega.norm() * exact.norm()) << hz;
  }
}

TEST(FreeMotion, FallsAlongAParabolaWhateverTheStep) {
  Workspace work;
  for (const double hz : long_runs::some_of({50.0, 100.0, 1000.0})) {
    Tree body = testing::box({0.1, 0.2, 0.3}, 2, {});
    body.v[3] = 1;
    testing::weigh(body);
    for (int i = 0; i < hz; ++i) integrate_free_motion(body, work, 1 / hz);
    EXPECT_NEAR(body.position[0].x(), 1, 1e-12);
    EXPECT_NEAR(body.position[0].z(), -g / 2, 1e-11);
  }
}

// L. D. Landau, E. M. Lifshitz, Mechanics, section 37: the components of the angular velocity in
// the body are Jacobi's elliptic functions, of period 4 K(k) / rate.
TEST(FreeMotion, AnAsymmetricBodyKeepsEnergyAndMomentumForAMinuteAndFlipsOnTime) {
  Workspace work;
  Tree body = testing::box({0.1, 0.2, 0.3}, 1, {});
  const Vector3 inertia = body.links[0].inertia;  // falls: about x most
  body.v[0] = 0.01, body.v[1] = 8, body.v[2] = 0.02;
  velocity_kinematics(body);
  const double energy = kinetic_energy(body);
  const Vector3 momentum = angular_momentum(body);
  const double i3 = inertia.x(), i2 = inertia.y(), i1 = inertia.z(), l2 = momentum.squaredNorm();
  ASSERT_GT(i3, i2);
  double rate, square;  // of k
  if (l2 > 2 * energy * i2) {
    rate = std::sqrt((i3 - i2) * (l2 - 2 * energy * i1) / (i1 * i2 * i3));
    square = (i2 - i1) * (2 * energy * i3 - l2) / ((i3 - i2) * (l2 - 2 * energy * i1));
  } else {
    rate = std::sqrt((i2 - i1) * (2 * energy * i3 - l2) / (i1 * i2 * i3));
    square = (i3 - i2) * (l2 - 2 * energy * i1) / ((i2 - i1) * (2 * energy * i3 - l2));
  }
  const double half_period = 2 * std::comp_ellint_1(std::sqrt(square)) / rate;
  double first = 0, last = 0, before = 8;
  int flips = 0;
  for (int i = 1; i <= 6000; ++i) {
    integrate_free_motion(body, work, 0.01);
    const double middle = (body.rotation[0].transpose() * body.spatial_velocity[0].angular).y();
    if (middle * before < 0) {
      last = 0.01 * (i - middle / (middle - before));
      if (flips++ == 0) first = last;
    }
    before = middle;
    ASSERT_NEAR(kinetic_energy(body) / energy, 1, 1e-4) << i;
    ASSERT_NEAR((angular_momentum(body) - momentum).norm() / momentum.norm(), 0, 1e-10) << i;
  }
  ASSERT_GT(flips, 3);
  EXPECT_NEAR((last - first) / (flips - 1) / half_period, 1, 0.002);
}

TEST(FreeMotion, TurnsExactlyAtAnySpeed) {
  Workspace work;
  Tree ball = testing::box({0.1, 0.1, 0.1}, 1, {});
  ball.v[2] = 526;
  for (int i = 0; i < 100; ++i) integrate_free_motion(ball, work, 0.01);
  const Matrix3 turned = Eigen::AngleAxisd(526, Vector3::UnitZ()).toRotationMatrix();
  EXPECT_NEAR((ball.rotation[0] - turned).norm(), 0, 1e-9);
  EXPECT_DOUBLE_EQ(ball.v[2], 526);
}

/// A spinning disc on a rod whose other end is fixed: at a level axis the steady precession is
/// exactly m g l / (I spin).
double precession_error(double hz, double spin) {
  Workspace work;
  Link disc;
  disc.mass = 1;
  disc.inertia = Vector3(0.005, 0.0025, 0.0025);  // axis along x
  const double arm = 0.1;
  Tree top({testing::ground(), testing::hung(disc, 0, JointType::spherical, {0, 0, 1},
                                             Vector3::Zero(), Vector3(arm, 0, 0))},
           {});
  testing::weigh(top);
  const double precession = g * arm / (0.005 * spin);
  top.v = {spin, 0, precession};
  const double seconds = 2;
  double angle = 0, before = 0;
  for (int i = 0; i < seconds * hz; ++i) {
    integrate_free_motion(top, work, 1 / hz);
    const double now = std::atan2(top.position[1].y(), top.position[1].x());
    angle += std::remainder(now - before, 2 * std::numbers::pi);
    before = now;
  }
  return std::abs(angle / (precession * seconds) - 1);
}

TEST(FreeMotion, AGyroscopePrecesses) {
  EXPECT_LT(precession_error(100, 300), 0.001);
  EXPECT_LT(precession_error(100, 100), 0.001);
  EXPECT_LT(precession_error(1000, 300), 0.0001);
}

double energy_error(Tree tree, double seconds, double hz, double scale) {
  Workspace work;
  testing::weigh(tree);
  const double energy = testing::energy(tree);
  double worst = 0;
  for (int i = 0; i < seconds * hz; ++i) {
    integrate_free_motion(tree, work, 1 / hz);
    worst = std::max(worst, std::abs(testing::energy(tree) - energy) / scale);
  }
  return worst;
}

TEST(FreeMotion, PendulumsKeepTheirEnergy) {
  // Relative to the energy between hanging and level.
  EXPECT_LT(energy_error(testing::chain(2, 0.5, 1), 10, 100, 2 * g * 0.5), 1e-4);
  EXPECT_LT(energy_error(testing::chain(10, 0.1, 0.1), 2, 100, g * 0.5), 1e-4);
}

// A light chain with a load swings down like a pendulum of its length: v = sqrt(2 g l).
TEST(FreeMotion, ALightChainSwingsAHeavyLoad) {
  Workspace work;
  constexpr int count = long_runs::links_of_a_chain;
  for (const double hz : long_runs::first_of({100, 1000})) {
    Tree tree = testing::chain(count, 1.0 / count, 0.01, 100);
    testing::weigh(tree);
    double fastest = 0;
    for (int i = 0; i < hz; ++i) {
      integrate_free_motion(tree, work, 1 / hz);
      fastest = std::max(fastest, tree.velocity(count).norm());
    }
    EXPECT_NEAR(fastest, std::sqrt(2 * g), 0.02 * std::sqrt(2 * g)) << hz;
  }
}

// It ended after 4 000 steps, 44 % of the substep, and fell in slow motion.
TEST(FreeMotion, AChainOfAMillionthOfItsLoadTakesAllOfItsSteps) {
  Workspace work;
  constexpr int count = long_runs::links_of_a_chain;
  Tree coarse = testing::chain(count, 1.0 / count, 1e-3, 1000), fine = coarse;
  for (Tree* tree : {&coarse, &fine}) {
    testing::weigh(*tree);
    const int steps = tree == &coarse ? 3 : 30;
    for (int i = 0; i < steps; ++i) integrate_free_motion(*tree, work, 0.06 / steps);
  }
  EXPECT_FALSE(work.ran_out_of_steps);
  EXPECT_LT((coarse.position[count] - fine.position[count]).norm(), 1e-5);
}

TEST(FreeMotion, IsLateWhereAChainIsTooStiff) {
  Workspace work;
  Tree tree = testing::chain(5, 0.2, 1e-7, 1e5);
  testing::weigh(tree);
  integrate_free_motion(tree, work, 0.02);
  EXPECT_TRUE(work.ran_out_of_steps);
}

}  // namespace
}  // namespace ziggurat::dynamics
