// SPDX-License-Identifier: MIT
#pragma once
// Line of sight between a camera and the things that it detects, and the pictures it takes.

#include <cstddef>
#include <span>
#include <vector>

#include "physics/collision/ray.h"
#include "render/renderer.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::devices {

/// Whether nothing stands between a camera and a point, both in W [m]: anything but the floor is in
/// the way, the camera's robot and the carrier of what is at the point included; not what is met
/// within 0.1 mm of the point, nor a body that the camera is inside of.
struct OcclusionTest {
  const physics::Rays& rays;
  std::size_t robot;                      ///< into Layout::robots: the one with the camera
  std::vector<world::Ray>* shown;         ///< gets the tested rays; may be null
  std::vector<world::Ray>* all;           ///< the same
  const physics::Candidates& candidates;  ///< what can be in the way

  std::size_t& left;  ///< lines of sight that may still be tested at this tick

  /// @throws std::runtime_error if none is left
  bool clear(const math::Vector3& eye, const math::Vector3& target) const;
};

/// View of a camera. @param pose  X_WC
render::View view_of(const world::CameraLayout& camera, const math::Pose& pose);

}  // namespace ziggurat::devices
