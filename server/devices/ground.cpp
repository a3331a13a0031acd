// SPDX-License-Identifier: MIT
// Ground sensors: how bright the floor of the arena is below a point, as its picture says, and what
// directors painted over it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "devices/described.h"
#include "images/image.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind ground{.name = "ground", .readings = {{"value"}}};
constexpr world::DeviceKind base_ground{.name = "footbot_base_ground",
                                        .readings = {{"value"}},
                                        .properties = {{"offset_x", "m"}, {"offset_y", "m"}}};
constexpr world::DeviceKind motor_ground{.name = "footbot_motor_ground",
                                         .readings = {{"value"}},
                                         .properties = {{"offset_x", "m"}, {"offset_y", "m"}}};

constexpr world::DeviceKind epuck_ground{.name = "epuck_ground",
                                         .readings = {{"value"}},
                                         .properties = {{"offset_x", "m"}, {"offset_y", "m"}}};

/// Brightness of a colour as the eye weighs its parts, 0 ... 1 (ITU-R BT.601); of white exactly 1.
double brightness(world::Color color) {
  const double red = color >> 16, green = color >> 8 & 0xFF, blue = color & 0xFF;
  return (299 * red + 587 * green + 114 * blue) / (1000 * 255.0);
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
    arena_ = scene::ground_of(setting.scene.arena);
  }

  double brightness_at(const world::State& state, const math::Vector3& place) const {
    if (const auto painted = painted_color(state.floor, place.x(), place.y()))
      return brightness(*painted);
    constexpr std::uint32_t white = 0xFFFFFF;  // all around an image, too
    if (!image_) return brightness(white);
    return brightness(images::color_at(*image_, arena_, place.x(), place.y()).value_or(white));
  }

  void read(Tick& tick, Robot& robot) override {
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const world::DescribedDevice& device = tick.layout.described[robot.devices.begin + i];
      const double seen = with_noise(
          robot, brightness_at(tick.state, world::position_of(tick.state, device.mount)));
      const bool is_binary = !robot.places[i].settings.empty();
      tick.observations.device_readings[device.readings.begin] =
          is_binary ? (seen < 0.5 ? 0.0 : 1.0) : std::clamp(seen, 0.0, 1.0);
    }
  }

  std::shared_ptr<const images::Image> image_;  // null: the floor is white
  images::Rectangle arena_;
};

}  // namespace

std::unique_ptr<Kind> make_ground() { return std::make_unique<GroundSensors>(ground); }
std::unique_ptr<Kind> make_epuck_ground() { return std::make_unique<GroundSensors>(epuck_ground); }
std::unique_ptr<Kind> make_footbot_base_ground() {
  return std::make_unique<GroundSensors>(base_ground);
}
std::unique_ptr<Kind> make_footbot_motor_ground() {
  return std::make_unique<GroundSensors>(motor_ground);
}

}  // namespace ziggurat::devices
