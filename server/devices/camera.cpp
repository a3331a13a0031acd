// SPDX-License-Identifier: MIT
// Cameras: each looks for LEDs, directional LEDs and tags at the end of a tick's physics.

#include "devices/camera.h"

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "camera/detectors.h"
#include "devices/kind.h"
#include "render/renderer.h"
#include "world/limits.h"

namespace ziggurat::devices {

bool OcclusionTest::clear(const math::Vector3& eye, const math::Vector3& target) const {
  if (left == 0) {
    throw std::runtime_error(
        "cameras look for LEDs and tags along more than " +
        std::to_string(world::most_lines_of_sight) +
        " lines of sight at a tick; write a smaller range on <camera>, or fewer cameras");
  }
  --left;
  constexpr double at_target = 1e-4;  // devices may be mounted flush [m]
  const math::Vector3 way = target - eye;
  const double length = way.norm();
  const physics::RayQuery ray{eye, target, {}, false};
  const auto hit = rays.cast(ray, candidates);
  const bool blocked = hit && hit->distance < length - at_target;
  if (shown || all) {
    const math::Vector3 end =
        blocked ? math::Vector3(eye + way * (hit->distance / length)) : target;
    for (auto* to : {shown, all}) {
      if (to) to->push_back({world::Ray::Kind::camera, robot, eye, end, blocked});
    }
  }
  return !blocked;
}

namespace {

world::CameraLayout camera_layout(const Carrier& carrier, const scene::Camera& from,
                                  const world::Layout& layout) {
  world::CameraLayout camera;
  camera.id = from.id;
  camera.mount = carrier.mount(carrier.anchor(from.anchor), from.pose, layout);
  camera.near = from.near;
  camera.far = from.far;
  camera.focal_length = from.focal_length;
  camera.principal_point = from.principal_point;
  camera.resolution = from.resolution;
  for (const scene::Detector& detector : from.detectors) {
    const world::DetectorLayout looks{detector.medium, detector.show_rays};
    switch (detector.kind) {
      case scene::Detector::Kind::led:
        camera.leds = looks;
        break;
      case scene::Detector::Kind::directional_led:
        camera.directional_leds = looks;
        break;
      case scene::Detector::Kind::tag:
        camera.tags = looks;
        break;
    }
  }
  camera.shows_frustum = carrier.enabled.cameras->show_frustum;
  camera.image = from.image;
  return camera;
}

class Cameras final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Cameras>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    robot.cameras.begin = layout.cameras.size();
    if (!carrier.enabled.cameras) return;
    robot.cameras =
        append(carrier.enabled.cameras->cameras, layout.cameras,
               [&](const auto& camera) { return camera_layout(carrier, camera, layout); });
  }

  void add(const Setting& setting) override {
    for (const world::CameraLayout& camera : setting.layout.cameras) {
      detects_ = detects_ || camera.leds || camera.directional_leds || camera.tags;
    }
  }

  // The detectors need both.
  bool casts_rays() const override { return detects_; }
  bool needs_index() const override { return detects_; }

  /// Replaces the readings of all cameras.
  void sense(Tick& tick) override {
    tick.observations.leds.clear();
    tick.observations.directional_leds.clear();
    tick.observations.tags.clear();
    lines_left_ = world::most_lines_of_sight;
    for (std::size_t robot = 0; robot < tick.layout.robots.size(); ++robot) {
      if (tick.state.is_absent(tick.layout.robots[robot].entity)) continue;
      const world::Range& cameras = tick.layout.robots[robot].cameras;
      for (std::size_t i = cameras.begin; i < cameras.end(); ++i) sense(tick, robot, i);
    }
  }

 private:
  void sense(Tick& tick, std::size_t robot, std::size_t camera) {
    const world::CameraLayout& lens = tick.layout.cameras[camera];
    const camera::View view(tick.layout, tick.state, tick.index, camera);
    if (lens.shows_frustum) tick.state.frusta.push_back({camera, view.corners});
    // All rays of a camera lie in the box of its eye and its frustum.
    tick.rays.find(view.bounds.low.cwiseMin(view.pose.position),
                   view.bounds.high.cwiseMax(view.pose.position), {}, candidates_);
    OcclusionTest sight{tick.rays, robot, nullptr, tick.all_rays, candidates_, lines_left_};
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

  bool detects_ = false;
  std::size_t lines_left_ = 0;  // as OcclusionTest has it
  std::vector<std::size_t> found_;
  physics::Candidates candidates_;  // of one camera
};

}  // namespace

std::unique_ptr<Kind> make_cameras() { return std::make_unique<Cameras>(); }

render::View view_of(const world::CameraLayout& camera, const math::Pose& pose) {
  render::View view{pose, camera.focal_length, camera.principal_point, camera.resolution[0],
                    camera.resolution[1]};
  view.oversampling = 1;  // four times as fast
  return view;
}

namespace {

class Pictures final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Pictures>(*this); }

  /// Without a camera that takes pictures, nothing is made.
  void add(const Setting& setting) override {
    for (const world::RobotLayout& robot : setting.new_robots()) {
      for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
        if (setting.layout.cameras[i].image) cameras_.push_back(i);
      }
    }
    if (renderer_) {
      for (std::size_t i = 0; i < setting.entities.size(); ++i) {
        const world::EntityLayout& entity = setting.layout.entities[setting.first_entity + i];
        renderer_->add(setting.entities[i], entity.links.begin);
      }
    } else if (!cameras_.empty()) {
      renderer_ =
          std::make_shared<render::Renderer>(setting.scene, setting.all_entities(), setting.layout);
    }
  }

  /// New cameras have empty pictures.
  void start(Tick& tick) override {
    for (std::size_t i = tick.observations.images.size(); i < cameras_.size(); ++i) {
      tick.observations.images.push_back({cameras_[i], {}});
    }
  }

  /// Replaces all of them.
  void sense(Tick& tick) override {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const world::CameraLayout& camera = tick.layout.cameras[cameras_[i]];
      std::vector<std::uint8_t>& rgb = tick.observations.images[i].rgb;
      if (tick.state.is_absent(camera.mount.entity)) {
        rgb.clear();
        continue;
      }
      std::swap(rgb, picture_.rgb);  // its memory is used again
      renderer_->draw(tick.state, view_of(camera, world::pose_of(tick.state, camera.mount)),
                      picture_);
      std::swap(rgb, picture_.rgb);
    }
  }

 private:
  std::vector<std::size_t> cameras_;            // into Layout::cameras, ascending
  std::shared_ptr<render::Renderer> renderer_;  // of copies, too: it draws what the layout has
  render::Picture picture_;
};

}  // namespace

std::unique_ptr<Kind> make_pictures() { return std::make_unique<Pictures>(); }

}  // namespace ziggurat::devices
