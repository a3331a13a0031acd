// Coordinates of joints from poses.

#include "channels/joints.h"

#include <gtest/gtest.h>

namespace ziggurat::channels {
namespace {

using math::Quaternion;
using math::Vector3;

math::Pose pose(const Vector3& at, double angle, const Vector3& about) {
  return {at, Quaternion(Eigen::AngleAxisd(angle, about.normalized()))};
}

TEST(Joints, AreReadFromTwoPosesInAnyPlace) {
  scene::Joint joint;
  joint.type = scene::JointType::revolute;
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
  joint.type = scene::JointType::prismatic;
  const math::Pose moved{0.7 * axis, Quaternion::Identity()};
  EXPECT_NEAR(position_of(joint, parent,
                          parent * joint.parent_frame * moved * math::inverse(joint.child_frame)),
              0.7, 1e-12);
  joint.type = scene::JointType::fixed;
  EXPECT_EQ(position_of(joint, parent, parent), 0);
}

}  // namespace
}  // namespace ziggurat::channels
