// SPDX-License-Identifier: MIT
// Coordinates of joints from poses and velocities.

#include "scene/joint_coordinates.h"

#include <gtest/gtest.h>

namespace ziggurat::scene {
namespace {

using math::Quaternion;
using math::Vector3;

math::Pose pose(const Vector3& at, double angle, const Vector3& about) {
  return {at, Quaternion(Eigen::AngleAxisd(angle, about.normalized()))};
}

TEST(Joints, AreReadFromTwoPosesInAnyPlace) {
  Joint joint;
  joint.type = JointType::revolute;
  joint.axis = Vector3(1, 2, -1).normalized();
  joint.parent_frame = pose({0.1, 0.2, 0.3}, 0.4, {1, 0, 2});
  joint.child_frame = pose({-0.3, 0, 0.1}, 1.1, {0, 3, 1});
  const math::Pose parent = pose({3, 1, 2}, 2.2, {1, 1, 1});
  const Vector3 axis = joint.child_frame.orientation.conjugate() * joint.axis;
  for (const double q : {-3.0, -0.5, 0.0, 1e-6, 2.5}) {
    // X_WC = X_WP X_PJ X_JJ'(q) X_J'C
    const math::Pose turned = pose({0, 0, 0}, q, axis);
    const math::Pose child =
        parent * joint.parent_frame * turned * math::inverse(joint.child_frame);
    EXPECT_NEAR(position_of(joint, parent, child), q, 1e-12);
  }
  joint.type = JointType::prismatic;
  const math::Pose moved{0.7 * axis, Quaternion::Identity()};
  EXPECT_NEAR(position_of(joint, parent,
                          parent * joint.parent_frame * moved * math::inverse(joint.child_frame)),
              0.7, 1e-12);
  joint.type = JointType::fixed;
  EXPECT_EQ(position_of(joint, parent, parent), 0);
}

/// The joint at a coordinate, and a moment later; the parent moves, too.
TEST(Joints, HaveTheVelocityWithWhichTheirPositionChanges) {
  Joint joint;
  joint.axis = Vector3(1, 2, -1).normalized();
  joint.parent_frame = pose({0.1, 0.2, 0.3}, 0.4, {1, 0, 2});
  joint.child_frame = pose({-0.3, 0, 0.1}, 1.1, {0, 3, 1});
  const Vector3 axis = joint.child_frame.orientation.conjugate() * joint.axis;
  const auto parent_at = [](double t) {
    return math::Pose{Vector3(3, 1, 2) + t * Vector3(0.5, -1, 2),
                      Quaternion(Eigen::AngleAxisd(0.7 * t, Vector3(0, 0.6, 0.8)))};
  };
  constexpr double rate = 1.7, dt = 1e-6;
  for (const JointType type : {JointType::revolute, JointType::prismatic}) {
    joint.type = type;
    const auto child_at = [&](double t) {
      const double q = 0.3 + rate * t;
      const math::Pose moved = type == JointType::revolute
                                   ? pose({0, 0, 0}, q, axis)
                                   : math::Pose{q * axis, Quaternion::Identity()};
      return parent_at(t) * joint.parent_frame * moved * math::inverse(joint.child_frame);
    };
    const auto motion = [&](const auto& at) {
      const math::Pose before = at(-dt), after = at(dt);
      const Eigen::AngleAxisd turned(after.orientation * before.orientation.conjugate());
      return LinkMotion{at(0.0), (after.position - before.position) / (2 * dt),
                        turned.angle() * turned.axis() / (2 * dt)};
    };
    EXPECT_NEAR(velocity_of(joint, motion(parent_at), motion(child_at)), rate, 1e-6);
  }
  joint.type = JointType::fixed;
  EXPECT_EQ(velocity_of(joint, {}, {}), 0);
}

}  // namespace
}  // namespace ziggurat::scene
