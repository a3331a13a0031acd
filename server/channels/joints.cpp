#include "channels/joints.h"

#include <cmath>
#include <numbers>

namespace ziggurat::channels {

double position_of(const scene::Joint& joint, const math::Pose& parent, const math::Pose& child) {
  if (!scene::has_coordinate(joint.type)) return 0;
  // X_PC of the joint's two frames, which are one as assembled; its axis is the same in both.
  const math::Pose moved = math::inverse(parent * joint.parent_frame) * (child * joint.child_frame);
  const math::Vector3 axis = joint.child_frame.orientation.conjugate() * joint.axis;
  if (joint.type == scene::JointType::prismatic) return moved.position.dot(axis);
  const math::Quaternion& turned = moved.orientation;
  const double angle = 2 * std::atan2(turned.vec().dot(axis), turned.w());
  return std::remainder(angle, 2 * std::numbers::pi);
}

}  // namespace ziggurat::channels
