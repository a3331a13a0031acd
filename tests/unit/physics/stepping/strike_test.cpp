// SPDX-License-Identifier: MIT
// Impacts of small islands with rolling friction. Normal impulses and rolling friction both resist
// the rotation of a cylinder's line, so its contacts conflict a little.

#include <gtest/gtest.h>

#include <random>

#include "physics/stepping/system.h"
#include "trees.h"

namespace ziggurat::dynamics {
namespace {

constexpr double half = 0.005, strike_substep = 0.01;  // [m], [s]

/// Numbers from -1 to 1 that are the same with every standard library.
class Draw {
 public:
  double operator()() { return random_() / 2147483647.5 - 1; }
  Vector3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
  std::mt19937 random_{1};
};

Tree striking_cube(double x, Draw& draw) {
  Tree tree = testing::box(Vector3::Constant(2 * half), 0.25,
                           {Vector3(x, 0, half), Quaternion::Identity()});
  tree.gravity = Vector3(0, 0, -testing::g);
  const Vector3 turning = 60 * draw.vector(), velocity = draw.vector();
  for (int k = 0; k < 3; ++k) tree.v[k] = turning[k], tree.v[3 + k] = velocity[k];
  tree.v[5] -= 1;  // falls
  velocity_kinematics(tree);
  return tree;
}

ContactPoint rolling_contact(int a, int b, const Vector3& point, const Vector3& normal,
                             double rolling, Draw& draw) {
  ContactPoint out;
  out.a.tree = a;
  out.b.tree = b;
  out.point = point;
  out.normal = normal;
  out.gap = 1e-6 * draw();
  out.friction = 0.25;
  out.rolling_friction = rolling;
  return out;
}

TEST(Strike, OfALineConverges) {
  Draw draw;
  for (int i = 0; i < 1000; ++i) {
    System system;
    system.trees.push_back(striking_cube(0, draw));
    std::vector<ContactPoint> contacts;
    for (const double side : {-half, half}) {
      contacts.push_back(rolling_contact(0, -1, {0, side, 0}, Vector3::UnitZ(), 2e-4, draw));
    }
    EXPECT_EQ(system.step(strike_substep, contacts).not_converged, 0) << i;
  }
}

// Two bodies side by side, that strike the floor with four points each, and each other with a line.
TEST(Strike, OfTwoOnTheFloorConverges) {
  Draw draw;
  for (int i = 0; i < 300; ++i) {
    System system;
    std::vector<ContactPoint> contacts;
    for (int body = 0; body < 2; ++body) {
      const double x = body == 0 ? -half : half;
      system.trees.push_back(striking_cube(x, draw));
      for (const double ahead : {-half, half}) {
        for (const double side : {-half, half}) {
          contacts.push_back(
              rolling_contact(body, -1, {x + ahead, side, 0}, Vector3::UnitZ(), 0, draw));
        }
      }
    }
    for (const double side : {-half, half}) {
      contacts.push_back(rolling_contact(0, 1, {0, side, half}, -Vector3::UnitX(), 4e-4, draw));
    }
    EXPECT_EQ(system.step(strike_substep, contacts).not_converged, 0) << i;
  }
}

}  // namespace
}  // namespace ziggurat::dynamics
