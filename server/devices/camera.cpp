#include "devices/camera.h"

namespace ziggurat::devices {
namespace {

constexpr double at_target = 1e-4;  // devices may be mounted flush [m]

}  // namespace

bool line_of_sight(const physics::Rays& rays, const math::Vector3& eye, const math::Vector3& target,
                   std::size_t robot, std::vector<world::Ray>* shown) {
  const math::Vector3 way = target - eye;
  const double length = way.norm();
  const auto hit = rays.cast({eye, target, {}, false});
  const bool blocked = hit && hit->distance < length - at_target;
  if (shown) {
    const math::Vector3 end =
        blocked ? math::Vector3(eye + way * (hit->distance / length)) : target;
    shown->push_back({world::Ray::Kind::camera, robot, eye, end, blocked});
  }
  return !blocked;
}

Cameras::Cameras(const Setting& setting) {
  for (const world::CameraLayout& camera : setting.layout.cameras) {
    detects_ = detects_ || camera.leds || camera.directional_leds || camera.tags;
  }
}

void Cameras::sense(Tick& tick) {
  tick.observations.leds.clear();
  tick.observations.directional_leds.clear();
  tick.observations.tags.clear();
  for (std::size_t robot = 0; robot < tick.layout.robots.size(); ++robot) {
    const world::Range& cameras = tick.layout.robots[robot].cameras;
    for (std::size_t i = cameras.begin; i < cameras.end(); ++i) sense(tick, robot, i);
  }
}

void Cameras::sense(Tick& tick, std::size_t robot, std::size_t camera) {
  const world::CameraLayout& lens = tick.layout.cameras[camera];
  const camera::View view(tick.layout, tick.state, tick.index, camera);
  if (lens.shows_frustum) tick.state.frusta.push_back({camera, view.corners});
  struct Sight {
    const physics::Rays& rays;
    std::size_t robot;
    std::vector<world::Ray>* shown = nullptr;
  } sight{tick.rays, robot};
  // One reference: a function that holds more would allocate.
  const camera::LineOfSight clear = [&sight](const math::Vector3& eye,
                                             const math::Vector3& target) {
    return line_of_sight(sight.rays, eye, target, sight.robot, sight.shown);
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
