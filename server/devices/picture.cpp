// Pictures of the cameras that ask for them, taken at the end of a tick's physics.

#include "devices/picture.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "devices/kind.h"
#include "render/renderer.h"

namespace ziggurat::devices {

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

  /// Without a camera that takes pictures, nothing is made, and nothing of OpenGL is loaded.
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

  /// New cameras have empty pictures. @throws render::RenderError if none can be made
  void start(Tick& tick) override {
    for (std::size_t i = tick.observations.images.size(); i < cameras_.size(); ++i) {
      tick.observations.images.push_back({cameras_[i], {}});
    }
    if (renderer_) renderer_->prepare();
  }

  /// Replaces all of them. @throws render::RenderError
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
