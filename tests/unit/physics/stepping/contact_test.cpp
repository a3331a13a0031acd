// SPDX-License-Identifier: MIT
// Bodies in contact against closed forms.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "../../long_runs.h"
#include "touching.h"

namespace ziggurat::dynamics {
namespace {

using testing::at;
using testing::g;
using testing::Touching;

struct Slide {
  double distance = 0, yaw = 0, worst_gap = 0, iterations = 0;
  Report worst;
};

/// A cube of 10 cm on a slope for a time, gravity tilted instead of the slope.
Slide slide(double hz, double seconds, double slope, double mu, double start = 0) {
  Touching world;
  world.gravity = Vector3(g * std::sin(slope), 0, -g * std::cos(slope));
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  world.add_box({0.1, 0.1, 0.1}, 1, at(0, 0, 0.05), mu);
  world.system.sleeping.enabled = false;
  world.tree(0).v[3] = start;
  velocity_kinematics(world.tree(0));
  Slide out;
  for (int i = 0; i < seconds * hz; ++i) {
    world.step(1 / hz);
    out.worst_gap = std::max(out.worst_gap, std::abs(world.tree(0).position[0].z() - 0.05));
  }
  out.distance = world.tree(0).position[0].x();
  out.yaw = (world.tree(0).rotation[0] - Matrix3::Identity()).norm();
  out.worst = world.worst;
  return out;
}

TEST(Contact, ABoxSlidesDownASlopeAtEveryStep) {
  const double slope = 0.5, mu = 0.3, seconds = 3;
  const double a = g * (std::sin(slope) - mu * std::cos(slope));
  for (const double hz : long_runs::some_of({50., 100., 200., 500., 700., 1000., 2000., 4000.})) {
    const Slide result = slide(hz, seconds, slope, mu);
    const double exact = a * seconds * seconds / 2;
    // Semi-implicit steps go the sum of h^2 i: longer by h / t.
    EXPECT_NEAR(result.distance / exact, 1 + 1 / (hz * seconds), 1e-4) << hz;
    EXPECT_LT(result.yaw, 1e-6) << hz;
    EXPECT_LT(result.worst_gap, 1e-6) << hz;
    EXPECT_EQ(result.worst.not_converged, 0) << hz;
    std::printf("%5.0f Hz: %.5f %% yaw %.1e gap %.1e miss %.1e iterations %d\n", hz,
                100 * (result.distance / exact - 1), result.yaw, result.worst_gap,
                result.worst.residual, result.worst.most_iterations);
  }
}

TEST(Contact, ABoxSticksBelowTheAngleOfFriction) {
  for (const double hz : long_runs::some_of({50., 100., 1000.})) {
    const Slide result = slide(hz, long_runs::a_minute, std::atan(0.3) - 1e-3, 0.3);
    EXPECT_LT(std::abs(result.distance), 1e-6) << hz;
    std::printf("%5.0f Hz creeps %.2e m, iterations %d\n", hz, result.distance,
                result.worst.most_iterations);
  }
}

TEST(Contact, ASliderStaysOnTheFloorAndStopsWhereItShould) {
  const Slide result = slide(100, 2, 0, 0.3, 3);
  const double exact = 9 / (2 * 0.3 * g);
  std::printf("stops after %.5f of %.5f m, gap %.2e\n", result.distance, exact, result.worst_gap);
  EXPECT_NEAR(result.distance, exact - 3 * 0.005, 2e-3);
  EXPECT_LT(result.worst_gap, 1e-6);
}

// Pressed against a wall and the floor at once: the acceleration along both is
// g_x - mu (g_wall + g_floor).
TEST(Contact, ABoxSlidesAlongFloorAndWall) {
  for (const double hz : long_runs::some_of({100., 1000.})) {
    Touching world;
    world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
    world.planes.push_back({Vector3::Zero(), Vector3::UnitY()});
    world.gravity = Vector3(6, -4, -g);
    world.add_box({0.1, 0.1, 0.1}, 1, at(0, 0.05, 0.05), 0.2);
    for (int i = 0; i < hz; ++i) world.step(1 / hz);
    const double speed = world.tree(0).v[3];
    EXPECT_NEAR(speed / (6 - 0.2 * (4 + g)), 1, 1e-4) << hz;
    std::printf("%g Hz %.6f of %.6f, iterations %d, not converged %d\n", hz, speed,
                6 - 0.2 * (4 + g), world.worst.most_iterations, world.worst.not_converged);
  }
}

void tower(int count, double side, double seconds, double hz, double ratio = 1) {
  Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  world.system.sleeping.enabled = false;
  double mass = 1000 * side * side * side;
  for (int i = 0; i < count; ++i) {
    world.add_box({side, side, side}, mass, at(0, 0, side * (i + 0.5)), 0.7);
    mass *= ratio;
  }
  for (int i = 0; i < seconds * hz; ++i) world.step(1 / hz);
  const Vector3 top = world.tree(count - 1).position[0];
  const double drift = (top - Vector3(0, 0, side * (count - 0.5))).norm();
  EXPECT_LT(drift, 1e-4) << count;
  std::printf("%d x %g m, ratio %g: drift %.2e m, iterations %d, not converged %d, miss %.1e\n",
              count, side, ratio, drift, world.worst.most_iterations, world.worst.not_converged,
              world.worst.residual);
}

TEST(Contact, TowersStand) {
  tower(10, 0.01, long_runs::a_minute, 100);
  tower(20, 0.01, long_runs::a_minute, 100);
  tower(20, 0.05, long_runs::a_minute, 100);
}

TEST(Contact, HeavyBoxesStandOnLightOnes) {
  tower(2, 0.1, 20, 100, 100);
  tower(2, 0.1, 20, 100, 1000);
  tower(3, 0.1, 20, 100, 100);
}

// Impulses of a prediction start the step's solution, but do not count as a load that was carried
// before: the impact still ends at the surface.
TEST(Contact, APredictedImpactStartsTheStep) {
  constexpr double time_step = 0.01, gap = 1e-3;
  Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  for (const double z : {0.05, 0.15})
    world.add_box(Vector3::Constant(0.1), 1, at(0, 0, z + gap), 0.5);
  for (int i = 0; i < 2; ++i) {
    world.tree(i).gravity = world.gravity;
    world.tree(i).v[5] = -2 - i;
    velocity_kinematics(world.tree(i));
  }
  world.find(time_step);
  world.system.wake_disturbed(time_step, world.contacts, {});
  PredictedVelocities prediction;
  ASSERT_TRUE(world.system.predict_velocities({}, gap, std::array{0, 1}, prediction));
  double normal = 0;
  for (const ContactPoint& contact : world.contacts) {
    if (contact.b.tree < 0) normal += contact.impulse.z();
    EXPECT_FALSE(contact.carried);
  }
  EXPECT_NEAR(normal, 2 * (2.5 - gap / time_step + g * time_step), 1e-4);
  EXPECT_EQ(world.system.advance({}).not_converged, 0);
  EXPECT_NEAR(world.tree(0).position[0].z(), 0.05, 1e-7);
}

}  // namespace
}  // namespace ziggurat::dynamics
