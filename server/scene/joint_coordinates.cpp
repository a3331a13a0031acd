// SPDX-License-Identifier: MIT
#include "scene/joint_coordinates.h"

#include <cmath>
#include <numbers>

namespace ziggurat::scene {

double position_of(const Joint& joint, const math::Pose& parent, const math::Pose& child) {
  if (!has_coordinate(joint.type)) return 0;
  // X_PC of the joint's two frames, which are one as assembled; its axis is the same in both.
  const math::Pose moved = math::inverse(parent * joint.parent_frame) * (child * joint.child_frame);
  const math::Vector3 axis = joint.child_frame.orientation.conjugate() * joint.axis;
  if (joint.type == JointType::prismatic) return moved.position.dot(axis);
  const math::Quaternion& turned = moved.orientation;
  const double angle = 2 * std::atan2(turned.vec().dot(axis), turned.w());
  return std::remainder(angle, 2 * std::numbers::pi);
}

double velocity_of(const Joint& joint, const LinkMotion& parent, const LinkMotion& child) {
  if (!has_coordinate(joint.type)) return 0;
  const math::Vector3 axis = child.pose.orientation * joint.axis;
  if (joint.type == JointType::revolute) {
    return (child.angular_velocity - parent.angular_velocity).dot(axis);
  }
  // Velocities of the same point as part of the child, and of the parent.
  const math::Vector3 point = (child.pose * joint.child_frame).position;
  const auto velocity_at = [&](const LinkMotion& link) -> math::Vector3 {
    return link.velocity + link.angular_velocity.cross(point - link.pose.position);
  };
  return (velocity_at(child) - velocity_at(parent)).dot(axis);
}

}  // namespace ziggurat::scene
