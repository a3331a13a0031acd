// SPDX-License-Identifier: MIT
// The laws of constraints: impulses that obey them, and derivatives against differences.

#include "physics/solver/contact_law.h"

#include <gtest/gtest.h>

namespace ziggurat::dynamics {
namespace {

using Rows = std::array<double, Constraint::most_rows>;

/// A contact with all kinds of friction: bounds of 1 N s, 0.04 and 0.02 N m s at a normal impulse
/// of 2 N s.
Constraint contact() {
  ContactPoint point;
  point.friction = 0.5;
  point.spinning_friction = 0.02;
  point.rolling_friction = 0.01;
  Constraint out;
  set_law(point, out);
  out.mobility = {0.7, 0.9, 0.9, 30, 40, 40};
  return out;
}

void expect_obeyed(const Constraint& constraint, const Rows& u) {
  EXPECT_NEAR(residual(constraint, u.data()), 0, 1e-15);
  EXPECT_NEAR(merit(constraint, u.data()), 0, 1e-30);
  LinearisedLaw linear;
  linearise(constraint, u.data(), linear);
  for (int r = 0; r < constraint.rows; ++r) {
    double impulse = linear.constant[r];
    for (int c = 0; c < constraint.rows; ++c)
      impulse -= linear.hessian[r * constraint.rows + c] * u[c];
    EXPECT_NEAR(impulse, constraint.impulse[r], 1e-12) << r;
  }
}

TEST(ContactLaw, HoldsWhatSticksAndOpposesWhatSlides) {
  Constraint constraint = contact();
  constraint.impulse = {2, 0.3, 0.4, 0.01, 0.01, -0.01};
  expect_obeyed(constraint, {});
  constraint.impulse = {2, -0.6, -0.8, -0.04, 0.016, -0.012};
  expect_obeyed(constraint, {0, 0.3, 0.4, 5, -4, 3});
  constraint.impulse[1] = -0.61;
  EXPECT_GT(residual(constraint, Rows{0, 0.3, 0.4, 5, -4, 3}.data()), 1e-3);
}

TEST(ContactLaw, PushesOnlyAndServosNoMoreThanTheirStrength) {
  Constraint apart = contact(), servo;
  EXPECT_EQ(residual(apart, Rows{0.1, 1, 1, 1, 1, 1}.data()), 0);
  EXPECT_NEAR(residual(apart, Rows{-0.1}.data()), 0.1, 1e-15);
  Servo strength;
  strength.lower = -1, strength.upper = 3;
  set_law(strength, servo);
  servo.mobility[0] = 2;
  servo.impulse[0] = 3;
  expect_obeyed(servo, {-0.5});
  EXPECT_NEAR(residual(servo, Rows{0.5}.data()), 0.5, 1e-15);
}

TEST(ContactLaw, HasTheDerivativesOfItsRegularisedImpulses) {
  constexpr double step = 1e-7, regularisation = 0.1;
  Constraint constraint = contact();
  constraint.multiplier = {2, 0.1, 0.2, 0.01, 0.005, 0.002};
  for (const Rows& u :
       {Rows{-0.1, 0.01, 0.02, 0.01, 0.01, 0.01}, Rows{-0.1, 0.3, 0.5, 0.4, -0.2, 0.1},
        Rows{0.1, 0.3, 0.01, 0.4, 0.01, -0.02}}) {
    Rows impulse, more, less;
    LinearisedLaw linear;
    regularise(constraint, u.data(), regularisation, true, impulse.data(), &linear);
    for (int c = 0; c < constraint.rows; ++c) {
      Rows above = u, below = u;
      above[c] += step, below[c] -= step;
      regularise(constraint, above.data(), regularisation, true, more.data(), nullptr);
      regularise(constraint, below.data(), regularisation, true, less.data(), nullptr);
      for (int r = 0; r < constraint.rows; ++r) {
        EXPECT_NEAR(linear.hessian[r * constraint.rows + c], (less[r] - more[r]) / (2 * step), 1e-6)
            << r << ", " << c;
      }
    }
  }
}

}  // namespace
}  // namespace ziggurat::dynamics
