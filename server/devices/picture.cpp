#include "devices/picture.h"

#include <utility>

namespace ziggurat::devices {

render::View view_of(const world::CameraLayout& camera, const math::Pose& pose) {
  render::View view{pose, camera.focal_length, camera.principal_point, camera.resolution[0],
                    camera.resolution[1]};
  view.oversampling = 1;  // four times as fast
  return view;
}

void Pictures::add(const Setting& setting) {
  for (const world::RobotLayout& robot : setting.new_robots()) {
    for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
      if (setting.layout.cameras[i].image) cameras_.push_back(i);
    }
  }
  if (renderer_) {
    for (const scene::Entity& entity : setting.entities) renderer_->add(entity);
  } else if (!cameras_.empty()) {
    renderer_.emplace(setting.scene, setting.all_entities(), setting.layout);
  }
}

void Pictures::start(Tick& tick) {
  for (std::size_t i = tick.observations.images.size(); i < cameras_.size(); ++i) {
    tick.observations.images.push_back({cameras_[i], {}});
  }
  if (renderer_) renderer_->prepare();
}

void Pictures::sense(Tick& tick) {
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

}  // namespace ziggurat::devices
