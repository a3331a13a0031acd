// SPDX-License-Identifier: MIT
// Starts of a solver that turn with their tree.

#include <gtest/gtest.h>

#include "../stepping/trees.h"
#include "physics/solver/problem.h"

namespace ziggurat::dynamics::testing {
namespace {

/// A contact at a place under a body.
ContactPoint contact_with(const Vector3& normal, const Vector3& impulse) {
  ContactPoint contact;
  contact.a = {0, 0};
  contact.point = {0.1, 0.05, 0};
  contact.normal = normal;
  contact.friction = 0.5;
  contact.impulse = impulse;
  return contact;
}

// A turn by 0.02 rad: drift and friction turn with the body, what a wall gives does not.
TEST(TurnedStart, OfASteadyTurnIsItsSolution) {
  const double step = 0.01, rate = 2;
  Tree tree = box({0.2, 0.1, 0.1}, 1, {{0, 0, 0.05}, Quaternion::Identity()});
  weigh(tree);
  tree.v = {0, 0, rate, 0.3, 0.1, 0};
  velocity_kinematics(tree);
  Workspace work;
  Problem problem;
  problem.time_step = step;
  problem.add(tree, work, false);
  const Vector3 impulse(0.01, 0.02, 0.1);
  problem.add(contact_with(Vector3::UnitZ(), impulse), 0, -1, 0);
  problem.add(contact_with(Vector3::UnitX(), impulse), 0, -1, 1);
  const auto impulse_of = [&](int index) -> Vector3 {
    const Constraint& constraint = problem.constraints[index];
    return constraint.frame * Eigen::Map<const Vector3>(constraint.impulse.data());
  };
  turn_start(problem);
  const Matrix3 turn = Eigen::AngleAxisd(step * rate, Vector3::UnitZ()).toRotationMatrix();
  EXPECT_LT((impulse_of(0) - turn * impulse).norm(), 1e-15);
  EXPECT_LT((impulse_of(1) - impulse).norm(), 1e-15);
  const Eigen::Map<const Vector3> spin(problem.velocity.data()), drift(problem.velocity.data() + 3);
  EXPECT_LT((spin - Vector3(0, 0, rate)).norm(), 1e-15);
  EXPECT_LT((drift - turn * Vector3(0.3, 0.1, 0)).norm(), 1e-15);
}

// Two loads: one presses in as deep as it is, the other one is deeper by a thousandth.
TEST(SettledLoads, AreThoseThatArePressedInAsTheySay) {
  Tree tree = box({0.2, 0.1, 0.1}, 1, {{0, 0, 0.05}, Quaternion::Identity()});
  weigh(tree);
  Workspace work;
  Problem problem;
  problem.time_step = 0.01;
  problem.compliance_factor = 5e-5;
  problem.add(tree, work, false);
  const double load = tree.links[0].mass * g * problem.time_step / 2;
  for (const double more : {1e-6, 1e-3}) {
    ContactPoint contact = contact_with(Vector3::UnitZ(), {0, 0, load});
    contact.gap = -problem.time_step * problem.compliance_factor * load * (1 + more);
    problem.add(contact, 0, -1, 0);
  }
  problem.settle_loads();
  const double rest = problem.compliance_factor * load;
  EXPECT_EQ(problem.constraints[0].target_velocity[0], rest);
  EXPECT_NEAR(problem.constraints[1].target_velocity[0], rest * 1.001, 1e-15);
}

}  // namespace
}  // namespace ziggurat::dynamics::testing
