// SPDX-License-Identifier: MIT
#pragma once
// Simulated detectors: which LEDs, directional LEDs and tags a camera sees, and where in its image.
// Pure functions of poses; a function that the caller passes checks the line of sight.

#include <cstddef>
#include <functional>
#include <vector>

#include "camera/projection.h"
#include "media/devices_index.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::camera {

/// Whether nothing stands between a camera and a point, both in W [m].
using LineOfSight = std::function<bool(const math::Vector3& eye, const math::Vector3& target)>;

/// Whether a device faces a point: the angle between its +z axis and the way there is at most its
/// observable angle. At an observable angle of pi it always does.
/// @param device  X_WD;  @param point  in W [m];  @param observable_angle  half-angle [rad]
bool faces(const math::Pose& device, const math::Vector3& point, double observable_angle);

/// Corners of a tag in W [m], in the order of world::TagReading.
/// @param tag  X_WT;  @param side_length  [m]
std::array<math::Vector3, 4> tag_corners(const math::Pose& tag, double side_length);

/// One camera at one tick, and what it looks at.
struct View {
  View(const world::Layout& layout, const world::State& state, const media::DevicesIndex& index,
       std::size_t camera);

  const world::CameraLayout& lens() const { return layout.cameras[camera]; }
  /// Pixel of a point in W [m]; the line of sight is not checked.
  std::optional<math::Vector2> find(const math::Vector3& point) const {
    return in_view(lens(), from_world * point);
  }

  const world::Layout& layout;
  const world::State& state;
  const media::DevicesIndex& index;      ///< with the poses of `state`
  std::size_t camera;                    ///< into Layout::cameras
  math::Pose pose;                       ///< X_WC
  math::Pose from_world;                 ///< X_CW
  std::array<math::Vector3, 8> corners;  ///< of its frustum, in W [m]
  Bounds bounds;                         ///< of the frustum
};

// Each appends what is seen, in scene order; nothing if the camera has no such detector. The checks
// are: switched on, faces the camera, in view, line of sight. The first that fails ends them.
/// @param found  working memory

void detect_leds(const View& view, const LineOfSight& clear, std::vector<std::size_t>& found,
                 std::vector<world::LedReading>& readings);
void detect_directional_leds(const View& view, const LineOfSight& clear,
                             std::vector<std::size_t>& found,
                             std::vector<world::LedReading>& readings);
/// A tag is seen if all its corners are in view and in sight; its centre is not checked.
void detect_tags(const View& view, const LineOfSight& clear, std::vector<std::size_t>& found,
                 std::vector<world::TagReading>& readings);

}  // namespace ziggurat::camera
