// SPDX-License-Identifier: MIT
#pragma once
// Coordinates of joints, from the poses and velocities of the links that they connect.

#include "math/pose.h"
#include "scene/scene.h"

namespace ziggurat::scene {

/// 0 as assembled; of fixed and spherical joints always.
/// @param parent, child  X_WL of the links
/// @return [m], or [rad] in [-pi, pi]: whole turns can't be seen
double position_of(const Joint& joint, const math::Pose& parent, const math::Pose& child);

/// Motion of a link's frame.
struct LinkMotion {
  math::Pose pose;                                         ///< X_WL
  math::Vector3 velocity = math::Vector3::Zero();          ///< of the frame's origin, in W [m/s]
  math::Vector3 angular_velocity = math::Vector3::Zero();  ///< in W [rad/s]
};

/// The rate of position_of(). @return [m/s] or [rad/s]; 0 of fixed and spherical joints
double velocity_of(const Joint& joint, const LinkMotion& parent, const LinkMotion& child);

}  // namespace ziggurat::scene
