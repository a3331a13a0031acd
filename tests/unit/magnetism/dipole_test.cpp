// SPDX-License-Identifier: MIT
#include "magnetism/dipole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ziggurat::magnetism {
namespace {

Vector3 random_vector(std::mt19937_64& engine) {
  const auto real = [&engine] {
    return static_cast<double>(engine() >> 11) / 4503599627370496.0 - 1;
  };
  const double x = real();
  const double y = real();
  return {x, y, real()};
}

void expect_vector(const Vector3& actual, const Vector3& expected, double tolerance) {
  EXPECT_NEAR(actual.x(), expected.x(), tolerance);
  EXPECT_NEAR(actual.y(), expected.y(), tolerance);
  EXPECT_NEAR(actual.z(), expected.z(), tolerance);
}

// By hand: r = (2, 1, 2) cm, so d = 3 cm and n = (2, 1, 2) / 3. m1 = (1, 2, 0), m2 = (0, 1, 3):
// m1.n = 4/3, m2.n = 7/3, m1.m2 = 2, so m1.m2 - 5 (m1.n)(m2.n) = 2 - 140/9 = -122/9.
// Sum: 7/3 (1, 2, 0) + 4/3 (0, 1, 3) - 122/27 (2, 1, 2) = (-181, 40, -136) / 27.
// 3 K / d^4 = 3e-7 / 8.1e-7 = 10/27, hence F = 10 (-181, 40, -136) / 729 N.
// B1 d^3 / K = 3 (7/3) n - m2 = (14, 7, 14) / 3 - (0, 1, 3) = (14, 4, 5) / 3, and
// T1 = m1 x B1 = K / d^3 (10, -5, 4 - 28) / 3 = 1e-7 / 2.7e-5 (10, -5, -24) / 3 N m.
// B2 d^3 / K = 3 (4/3) n - m1 = (8, 4, 8) / 3 - (1, 2, 0) = (5, -2, 8) / 3, and
// T2 = m2 x B2 = K / d^3 (1*8 + 3*2, 3*5, -5) / 3 = K / d^3 (14, 15, -5) / 3.
TEST(DipolePair, HandDerivedForceAndTorqueInGeneralPosition) {
  const auto pair = dipole_pair({1, 2, 0}, {0, 1, 3}, {0.02, 0.01, 0.02});
  expect_vector(pair.force_on_first, Vector3(-181, 40, -136) * (10.0 / 729), 1e-14);
  const double scale = 1e-7 / 2.7e-5 / 3;
  expect_vector(pair.torque_on_first, Vector3(10, -5, -24) * scale, 1e-15);
  expect_vector(pair.torque_on_second, Vector3(14, 15, -5) * scale, 1e-15);
}

TEST(DipolePair, CoaxialDipolesAttractWithSixKOverTheFourthPower) {
  const auto pair = dipole_pair({0, 0, 2}, {0, 0, 3}, {0, 0, 0.1});
  expect_vector(pair.force_on_first, {0, 0, -6e-7 * 6 / 1e-4}, 1e-15);
  expect_vector(pair.torque_on_first, {0, 0, 0}, 0);
  // Side by side they repel with half of that.
  expect_vector(dipole_pair({0, 0, 2}, {0, 0, 3}, {0.1, 0, 0}).force_on_first,
                {3e-7 * 6 / 1e-4, 0, 0}, 1e-15);
}

TEST(DipolePair, ConservesMomentumAndAngularMomentum) {
  std::mt19937_64 engine(1);
  for (int k = 0; k < 1000; ++k) {
    const Vector3 m1 = random_vector(engine);
    const Vector3 m2 = random_vector(engine);
    const Vector3 r = 0.05 * random_vector(engine);
    const auto pair = dipole_pair(m1, m2, r);
    const Vector3 lever = r.cross(pair.force_on_first);
    const double scale = pair.torque_on_first.norm() + pair.torque_on_second.norm() + lever.norm();
    EXPECT_LE((pair.torque_on_first + pair.torque_on_second + lever).norm(), 1e-12 * scale);
    const auto swapped = dipole_pair(m2, m1, -r);
    EXPECT_EQ(swapped.force_on_first, -pair.force_on_first);
    EXPECT_EQ(swapped.torque_on_first, pair.torque_on_second);
  }
}

TEST(DipolePair, ForceAndTorqueAreTheEnergysDerivatives) {
  std::mt19937_64 engine(2);
  const double step = 1e-6;
  for (int k = 0; k < 100; ++k) {
    const Vector3 m1 = random_vector(engine);
    const Vector3 m2 = random_vector(engine);
    const Vector3 r = 0.03 * random_vector(engine).normalized();
    const auto pair = dipole_pair(m1, m2, r);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 shift = 0.03 * step * Vector3::Unit(axis);
      const double force =
          (dipole_energy(m1, m2, r - shift) - dipole_energy(m1, m2, r + shift)) / (0.06 * step);
      EXPECT_NEAR(pair.force_on_first[axis], force, 1e-7 * pair.force_on_first.norm());
      const Eigen::AngleAxisd forward(step, Vector3::Unit(axis));
      const Eigen::AngleAxisd backward(-step, Vector3::Unit(axis));
      const double torque =
          (dipole_energy(backward * m1, m2, r) - dipole_energy(forward * m1, m2, r)) / (2 * step);
      EXPECT_NEAR(pair.torque_on_first[axis], torque, 1e-8 * pair.force_on_first.norm());
    }
  }
}

TEST(DipolePair, StaysFiniteAndContinuousDownToZeroDistance) {
  const Vector3 m1(1, 2, 0);
  const Vector3 m2(0, 1, 3);
  const auto at_zero = dipole_pair(m1, m2, Vector3::Zero(), 1e-3);
  expect_vector(at_zero.force_on_first, {0, 0, 0}, 0);
  EXPECT_TRUE(at_zero.torque_on_first.allFinite());
  const Vector3 r(2e-3 / 3, 1e-3 / 3, 2e-3 / 3);
  const auto outside = dipole_pair(m1, m2, r * (1 + 1e-9), 1e-3);
  const auto inside = dipole_pair(m1, m2, r * (1 - 1e-9), 1e-3);
  expect_vector(inside.force_on_first, outside.force_on_first,
                1e-7 * outside.force_on_first.norm());
  const auto deep = dipole_pair(m1, m2, 0.3 * r, 1e-3);
  const Vector3 sum =
      deep.torque_on_first + deep.torque_on_second + (0.3 * r).cross(deep.force_on_first);
  EXPECT_LE(sum.norm(), 1e-12 * deep.torque_on_first.norm());
}

// Dialect 3.6: two fields of 65 at 5 cm attract with 6 k 65^2 / d^4 = 2.86 mN.
TEST(Dialect, FieldsBecomeMomentsWithTheSameForce) {
  const double force_constant = 7.0500949e-13;
  const Vector3 moment = moment_of_dialect_field({0, 0, 65}, force_constant);
  EXPECT_NEAR(moment.z(), 65 * 2.6552e-3, 1e-5);
  const auto pair = dipole_pair(moment, moment, {0, 0, 0.05});
  EXPECT_NEAR(pair.force_on_first.z(), -6 * force_constant * 65 * 65 / 6.25e-6, 1e-12);
  EXPECT_NEAR(pair.force_on_first.z(), -2.86e-3, 5e-6);
}

// Dialect A.6: one fixed, the other 1 g, 20 ticks of 1 ms from rest: 0.605 mm.
TEST(Dialect, DipolesAtFiveCentimetresMoveAsInTheReference) {
  const Vector3 moment = moment_of_dialect_field({0, 0, 65}, 7.0500949e-13);
  double z = 0.05;
  double velocity = 0;
  for (int tick = 0; tick < 20; ++tick) {
    velocity += 1e-3 * dipole_pair(moment, moment, {0, 0, z}).force_on_first.z() / 1e-3;
    z += 1e-3 * velocity;
  }
  EXPECT_NEAR(0.05 - z, 0.605e-3, 0.5e-6);
}

TEST(Moment, OfRemanenceIsPolarisationTimesVolume) {
  // A 6 mm sphere of N42 (1.30 T): 0.117 A m^2.
  EXPECT_NEAR(moment_of_remanence({0, 0, 1.3}, 4 * pi / 3 * 27e-9).z(), 0.117, 1e-3);
}

}  // namespace
}  // namespace ziggurat::magnetism
