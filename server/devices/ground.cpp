// Ground sensors: how bright the floor of the arena is below a point, as its picture says.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "devices/described.h"
#include "scene/floor_image.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind ground{.name = "ground", .readings = {{"value"}}};
constexpr world::DeviceKind base_ground{.name = "footbot_base_ground",
                                        .readings = {{"value"}},
                                        .properties = {{"offset_x", "m"}, {"offset_y", "m"}}};
constexpr world::DeviceKind motor_ground{.name = "footbot_motor_ground",
                                         .readings = {{"value"}},
                                         .properties = {{"offset_x", "m"}, {"offset_y", "m"}}};

constexpr double white = 1;

/// Brightness of a pixel as the eye weighs its colours, 0 ... 1 (ITU-R BT.601).
double brightness(const std::uint8_t* rgb) {
  return (299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2]) / (1000 * 255.0);  // of white exactly 1
}

/// Pixel of a place on a side of the arena; none outside.
std::optional<std::size_t> pixel(double place, double center, double size, unsigned pixels) {
  const double at = std::floor(((place - center) / size + 0.5) * pixels);
  if (!(at >= 0 && at < pixels)) return std::nullopt;
  return static_cast<std::size_t>(at);
}

class GroundSensors final : public Described {
 public:
  explicit GroundSensors(const world::DeviceKind& kind) : Described(kind) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<GroundSensors>(*this); }

 private:
  std::vector<double> properties(const scene::DevicePlace& place) const override {
    if (kind().properties.size() == 0) return {};
    return {place.pose.position.x(), place.pose.position.y()};
  }

  void add_others(const Setting& setting) override {
    image_ = setting.scene.floor_image;
    arena_ = setting.scene.arena;
  }

  /// The picture covers the arena: right is +x, up is +y. All around is white.
  double brightness_at(const math::Vector3& place) const {
    if (!image_) return white;
    const auto column = pixel(place.x(), arena_.center.x(), arena_.size.x(), image_->width);
    const auto row = pixel(place.y(), arena_.center.y(), arena_.size.y(), image_->height);
    if (!column || !row) return white;
    const std::size_t from_top = image_->height - 1 - *row;
    return brightness(&image_->rgb[3 * (from_top * image_->width + *column)]);
  }

  void read(Tick& tick, Robot& robot) override {
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const world::DescribedDevice& device = tick.layout.described[robot.devices.begin + i];
      const double seen =
          with_noise(robot, brightness_at(world::position_of(tick.state, device.mount)));
      const bool is_binary = !robot.places[i].settings.empty();
      tick.observations.device_readings[device.readings.begin] =
          is_binary ? (seen < 0.5 ? 0.0 : 1.0) : std::clamp(seen, 0.0, 1.0);
    }
  }

  std::shared_ptr<const scene::FloorImage> image_;  // null: the floor is white
  scene::Arena arena_;
};

}  // namespace

std::unique_ptr<Kind> make_ground() { return std::make_unique<GroundSensors>(ground); }
std::unique_ptr<Kind> make_footbot_base_ground() {
  return std::make_unique<GroundSensors>(base_ground);
}
std::unique_ptr<Kind> make_footbot_motor_ground() {
  return std::make_unique<GroundSensors>(motor_ground);
}

}  // namespace ziggurat::devices
