// SPDX-License-Identifier: MIT
// Light sensors: how bright the <light>s are that nothing hides.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind light{.name = "light", .readings = {{"value"}}};
constexpr world::DeviceKind footbot_light{
    .name = "footbot_light", .readings = {{"value"}}, .properties = {{"angle", "rad"}}};
constexpr world::DeviceKind eyebot_light{
    .name = "eyebot_light", .readings = {{"value"}}, .properties = {{"angle", "rad"}}};

constexpr world::DeviceKind epuck_light{
    .name = "epuck_light", .readings = {{"value"}}, .properties = {{"angle", "rad"}}};

/// Direction of a place about +z of its robot from +x, (-pi, pi] [rad].
double bearing_of(const scene::DevicePlace& place) {
  return std::atan2(place.pose.position.y(), place.pose.position.x());
}

class LightSensors : public Described {
 public:
  using Described::Described;

  bool casts_rays() const final { return !robots().empty() && !lights_.empty(); }

 protected:
  struct Light {
    std::size_t entity;  // into Layout::entities
    std::size_t led;     // into State::led_colors
    bool is_black;       // as the scene has it: no camera sees it, and it shines all the same
    double intensity;
  };

  void add_others(const Setting& setting) final {
    for (std::size_t i = 0; i < setting.entities.size(); ++i) {
      const scene::Entity& entity = setting.entities[i];
      if (!(entity.intensity.value_or(0) > 0)) continue;
      const std::size_t index = setting.first_entity + i;
      const std::size_t led = setting.layout.entities[index].leds.begin;
      lights_.push_back({index, led, setting.layout.leds[led].color == 0, *entity.intensity});
    }
  }

  /// Sets the readings of a robot, with noise, within 0 ... 1.
  void set(Tick& tick, Robot& robot, std::size_t sensor, double brightness) {
    const std::size_t place = tick.layout.described[robot.devices.begin + sensor].readings.begin;
    tick.observations.device_readings[place] = std::clamp(with_noise(robot, brightness), 0.0, 1.0);
  }

  /// Calls visit(light, its place in W) for each that shines.
  template <class Visit>
  void for_each_light(const Tick& tick, Visit visit) const {
    for (const Light& each : lights_) {
      const bool is_off = !each.is_black && tick.state.led_colors[each.led] == 0;
      if (is_off || tick.state.is_absent(each.entity)) continue;
      visit(each, tick.state.origins[each.entity].position);
    }
  }

  /// Whether nothing stands between two places in W.
  bool sees(Tick& tick, const Robot& robot, const math::Vector3& from, const math::Vector3& to,
            std::span<const std::size_t> ignored) const {
    tick.take_line();
    const auto hit = tick.rays.cast({from, to, ignored, false});
    tick.show({world::Ray::Kind::device, robot.index, from, to}, hit, robot.use.show_rays);
    return !hit;
  }

 private:
  std::vector<Light> lights_;  // of intensity above 0, in scene order
};

/// Sensors on a body that shadows those behind it: (intensity / distance)^2, whatever the
/// direction, over all lights.
class Photodiodes final : public LightSensors {
 public:
  Photodiodes() : LightSensors(light) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Photodiodes>(*this); }

 private:
  void read(Tick& tick, Robot& robot) override {
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const math::Vector3 eye =
          world::position_of(tick.state, tick.layout.described[robot.devices.begin + i].mount);
      double brightness = 0;
      for_each_light(tick, [&](const Light& each, const math::Vector3& place) {
        if (!sees(tick, robot, eye, place, {})) return;
        brightness += std::pow(each.intensity / (place - eye).norm(), 2);
      });
      set(tick, robot, i, brightness);
    }
  }
};

/// A ring that tells where light comes from. With d = distance to the robot's origin / intensity,
/// up to 2.5, a light adds exp(-2 d) (1 - 2 |angle to it| / pi) to those that face it.
class LightRing final : public LightSensors {
 public:
  explicit LightRing(const world::DeviceKind& kind) : LightSensors(kind) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<LightRing>(*this); }

 private:
  std::vector<double> properties(const scene::DevicePlace& place) const override {
    return {bearing_of(place)};
  }

  void read(Tick& tick, Robot& robot) override {
    constexpr double farthest = 2.5;
    const std::size_t own = tick.layout.robots[robot.index].entity;
    const math::Pose& origin = tick.state.origins[own];
    brightness_.assign(robot.devices.count, 0);
    for_each_light(tick, [&](const Light& each, const math::Vector3& place) {
      const double distance = (place - origin.position).norm() / each.intensity;
      if (distance > farthest || !sees(tick, robot, origin.position, place, std::array{own}))
        return;
      const math::Vector3 seen = math::inverse(origin) * place;
      const double bearing = std::atan2(seen.y(), seen.x());
      for (std::size_t i = 0; i < brightness_.size(); ++i) {
        const double aside =
            std::abs(std::remainder(bearing - bearing_of(robot.places[i]), 2 * std::numbers::pi));
        brightness_[i] += std::exp(-2 * distance) * std::max(0.0, 1 - 2 * aside / std::numbers::pi);
      }
    });
    for (std::size_t i = 0; i < brightness_.size(); ++i) set(tick, robot, i, brightness_[i]);
  }

  std::vector<double> brightness_;  // without noise
};

}  // namespace

std::unique_ptr<Kind> make_light() { return std::make_unique<Photodiodes>(); }
std::unique_ptr<Kind> make_footbot_light() { return std::make_unique<LightRing>(footbot_light); }
std::unique_ptr<Kind> make_eyebot_light() { return std::make_unique<LightRing>(eyebot_light); }
std::unique_ptr<Kind> make_epuck_light() { return std::make_unique<LightRing>(epuck_light); }

}  // namespace ziggurat::devices
