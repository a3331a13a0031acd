// SPDX-License-Identifier: MIT
// Layers over the world if a view asks for them: rays, frusta, names.
#include <algorithm>

#include "camera/projection.h"
#include "render/drawing.h"

namespace ziggurat::render {
namespace {

using math::Pose;
using math::Vector3;

constexpr double nearest = 0.01;  // of lines [m]
constexpr double above = 0.02;    // of names: over an entity's highest point [m]

/// Colours by what a ray is, and whether it met something.
Float3 color_of(const world::Ray& ray) {
  switch (ray.kind) {
    case world::Ray::Kind::proximity:
      return ray.hit ? Float3{0.86f, 0.20f, 0.16f} : Float3{0.25f, 0.62f, 0.93f};
    case world::Ray::Kind::radio:
      return {0.63f, 0.33f, 0.86f};
    case world::Ray::Kind::range_and_bearing:
      return ray.hit ? Float3{0.86f, 0.20f, 0.16f} : Float3{0.10f, 0.62f, 0.45f};
    case world::Ray::Kind::camera:
    case world::Ray::Kind::device:
      break;
  }
  return ray.hit ? Float3{0.86f, 0.20f, 0.16f} : Float3{0.93f, 0.62f, 0.10f};
}

/// The part of a segment that is in front of the camera, if any. @param start, end  in its frame
/// [m]
void add_line(Vector3 start, Vector3 end, const Float3& color, Drawing& drawing) {
  if (start.z() < nearest && end.z() < nearest) return;
  const auto cut = [](Vector3& hidden, const Vector3& seen) {
    if (hidden.z() >= nearest) return;
    hidden += (seen - hidden) * ((nearest - hidden.z()) / (seen.z() - hidden.z()));
  };
  cut(start, end);
  cut(end, start);
  drawing.lines.push_back({to_floats(start), to_floats(end), color});
}

}  // namespace

void Draftsman::add_rays(const world::State& state, const View& view, Drawing& drawing) const {
  const Pose camera_from_world = math::inverse(view.camera);
  for (const world::Ray& ray : state.rays) {
    add_line(camera_from_world * ray.start, camera_from_world * ray.end, color_of(ray), drawing);
  }
}

void Draftsman::add_frusta(const world::State& state, const View& view, Drawing& drawing) const {
  constexpr Float3 color{0.80f, 0.56f, 0.10f};
  const Pose camera_from_world = math::inverse(view.camera);
  for (const world::CameraLayout& camera : layout_.cameras) {
    if (state.is_absent(camera.mount.entity)) continue;
    auto corners = camera::frustum(camera, world::pose_of(state, camera.mount));
    for (Vector3& corner : corners) corner = camera_from_world * corner;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      add_line(corners[i], corners[next], color, drawing);
      add_line(corners[4 + i], corners[4 + next], color, drawing);
      add_line(corners[i], corners[4 + i], color, drawing);
    }
  }
}

void Draftsman::add_labels(const world::State& state, const View& view, Drawing& drawing) const {
  const Pose camera_from_world = math::inverse(view.camera);
  for (std::size_t i = 0; i < layout_.entities.size(); ++i) {
    const world::EntityLayout& entity = layout_.entities[i];
    if (state.is_absent(i) || entity.links.end() > model_.bodies.size()) continue;
    double top = state.origins[i].position.z();
    for (std::size_t link = entity.links.begin; link < entity.links.end(); ++link) {
      const Pose& pose = state.links[link].pose;
      const Vector3 up = pose.orientation.conjugate() * Vector3::UnitZ();
      const double highest = scene::reach(model_.bodies[link].geometry, up);
      top = std::max(top, pose.position.z() + highest);
    }
    Vector3 place = state.origins[i].position;
    place.z() = top + above;
    const Vector3 seen = camera_from_world * place;
    if (seen.z() < nearest) continue;
    drawing.labels.push_back(
        {entity.id, view.principal_point.x() + view.focal_length.x() * seen.x() / seen.z(),
         view.principal_point.y() + view.focal_length.y() * seen.y() / seen.z(), seen.z()});
  }
}

}  // namespace ziggurat::render
