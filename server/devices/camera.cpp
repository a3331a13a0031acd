#include "devices/camera.h"

namespace ziggurat::devices {
namespace {

constexpr double at_target = 1e-4;         // devices may be mounted flush [m]
constexpr std::size_t few_colliders = 32;  // more are left to the tree

}  // namespace

bool Sight::clear(const math::Vector3& eye, const math::Vector3& target) const {
  const math::Vector3 way = target - eye;
  const double length = way.norm();
  const physics::RayQuery ray{eye, target, {}, false};
  const auto hit = few ? rays.cast(ray, colliders) : rays.cast(ray);
  const bool blocked = hit && hit->distance < length - at_target;
  if (shown) {
    const math::Vector3 end =
        blocked ? math::Vector3(eye + way * (hit->distance / length)) : target;
    shown->push_back({world::Ray::Kind::camera, robot, eye, end, blocked});
  }
  return !blocked;
}

void Cameras::add(const Setting& setting) {
  for (const world::CameraLayout& camera : setting.layout.cameras) {
    detects_ = detects_ || camera.leds || camera.directional_leds || camera.tags;
  }
}

void Cameras::sense(Tick& tick) {
  tick.observations.leds.clear();
  tick.observations.directional_leds.clear();
  tick.observations.tags.clear();
  for (std::size_t robot = 0; robot < tick.layout.robots.size(); ++robot) {
    if (tick.state.is_absent(tick.layout.robots[robot].entity)) continue;
    const world::Range& cameras = tick.layout.robots[robot].cameras;
    for (std::size_t i = cameras.begin; i < cameras.end(); ++i) sense(tick, robot, i);
  }
}

void Cameras::sense(Tick& tick, std::size_t robot, std::size_t camera) {
  const world::CameraLayout& lens = tick.layout.cameras[camera];
  const camera::View view(tick.layout, tick.state, tick.index, camera);
  if (lens.shows_frustum) tick.state.frusta.push_back({camera, view.corners});
  // All rays of a camera lie in the box of its eye and its frustum.
  tick.rays.find(view.bounds.low.cwiseMin(view.pose.position),
                 view.bounds.high.cwiseMax(view.pose.position), colliders_);
  Sight sight{tick.rays, robot, nullptr, colliders_, colliders_.size() <= few_colliders};
  // One reference: a function that holds more would allocate.
  const camera::LineOfSight clear = [&sight](const math::Vector3& eye,
                                             const math::Vector3& target) {
    return sight.clear(eye, target);
  };
  const auto showing = [&](const std::optional<world::DetectorLayout>& detector) {
    return detector && detector->shows_rays ? &tick.state.rays : nullptr;
  };
  sight.shown = showing(lens.leds);
  camera::detect_leds(view, clear, found_, tick.observations.leds);
  sight.shown = showing(lens.directional_leds);
  camera::detect_directional_leds(view, clear, found_, tick.observations.directional_leds);
  sight.shown = showing(lens.tags);
  camera::detect_tags(view, clear, found_, tick.observations.tags);
}

}  // namespace ziggurat::devices
