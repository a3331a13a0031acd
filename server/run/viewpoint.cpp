// SPDX-License-Identifier: MIT
#include "run/viewpoint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace ziggurat::run {
namespace {

using math::Vector3;

/// A box's corners in the axes of a camera at the origin.
struct Corners {
  Corners(const Extent& box, const math::Quaternion& camera) {
    for (unsigned i = 0; i < 8; ++i) {
      const Vector3 point((i & 1u) ? box.high.x() : box.low.x(),
                          (i & 2u) ? box.high.y() : box.low.y(),
                          (i & 4u) ? box.high.z() : box.low.z());
      seen[i] = camera.conjugate() * point;
    }
  }

  /// The position nearest to them, in the camera's axes, from which all are within `half_width` and
  /// `half_height` (as x / z and y / z) of the picture's middle.
  Vector3 place(double half_width, double half_height) const {
    // The four planes through the camera and the picture's edges each touch a corner: two of them
    // give x and how far back, the other two y and how far back; the farther one counts.
    const auto along = [&](int axis, double half) {
      double low = -std::numeric_limits<double>::infinity(), high = low;
      for (const Vector3& each : seen) {
        high = std::max(high, each[axis] - half * each.z());
        low = std::max(low, -each[axis] - half * each.z());
      }
      return std::pair((high - low) / 2, -(high + low) / (2 * half));
    };
    const auto [x, back_x] = along(0, half_width);
    const auto [y, back_y] = along(1, half_height);
    return {x, y, std::min(back_x, back_y)};
  }

  std::array<Vector3, 8> seen;
};

}  // namespace

Extent extent_of(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                 const world::State& state) {
  const Vector3 half = 0.5 * scene.arena.size;
  Extent box{scene.arena.center - half, scene.arena.center + half};
  const bool is_flat = scene.arena.size.z() == 0;  // without a ceiling
  if (!scene.physics.floor && !is_flat) return box;
  double top = 0;
  std::size_t next = 0;
  for (const scene::Entity& entity : entities) {
    for (const scene::Link& link : entity.links) {
      const math::Pose& pose = state.links[next++].pose;
      top = std::max(
          top, pose.position.z() +
                   scene::reach(link.geometry, pose.orientation.conjugate() * Vector3::UnitZ()));
    }
  }
  if (scene.physics.floor) box.low.z() = 0;
  box.high.z() = is_flat ? std::max(box.low.z(), top) : std::min(std::max(box.high.z(), 0.0), top);
  return box;
}

Extent extent_about(const scene::Entity& entity, std::size_t first_link,
                    const world::State& state) {
  constexpr double nearby = 1.5;  // a cube's half side by the entity's diagonal
  Extent box{Vector3::Constant(std::numeric_limits<double>::infinity()), {}};
  box.high = -box.low;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const math::Pose& pose = state.links[first_link + i].pose;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 way = pose.orientation.conjugate() * Vector3::Unit(axis);
      const double at = pose.position[axis];
      const scene::Geometry& geometry = entity.links[i].geometry;
      box.low[axis] = std::min(box.low[axis], at - scene::reach(geometry, -way));
      box.high[axis] = std::max(box.high[axis], at + scene::reach(geometry, way));
    }
  }
  const Vector3 middle = 0.5 * (box.low + box.high);
  const Vector3 half = Vector3::Constant(nearby * (box.high - box.low).norm());
  return {middle - half, middle + half};
}

render::View choose_view(const ViewOptions& options, const Extent& box) {
  const auto view_from = [&](const math::Pose& camera) {
    auto view = render::symmetric_view(camera, options.opening, options.width, options.height);
    view.layers = options.layers;
    return view;
  };
  const Vector3 middle = 0.5 * (box.low + box.high);
  if (options.eye)
    return view_from(render::look_at(*options.eye, options.look_at.value_or(middle)));
  math::Pose camera = render::look_at({0.45, -0.75, 0.62}, Vector3::Zero());
  constexpr double margin = 0.95;  // of the picture's half size
  const double half_width = margin * std::tan(0.5 * options.opening);
  const double half_height = half_width * options.height / options.width;
  camera.position =
      camera.orientation * Corners(box, camera.orientation).place(half_width, half_height);
  if (options.look_at) camera.position += *options.look_at - middle;
  return view_from(camera);
}

}  // namespace ziggurat::run
