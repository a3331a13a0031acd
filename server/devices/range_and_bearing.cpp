// SPDX-License-Identifier: MIT
// Range and bearing: packets of all devices in range and sight, with noise and loss.

#include "media/range_and_bearing.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

/// Offset in the world of a normal length, whose inclination and azimuth are uniform: not the
/// uniform direction of a sphere, but that of the dialect.
math::Vector3 noise(math::RandomStream& random, double deviation) {
  if (deviation <= 0) return math::Vector3::Zero();
  const double length = random.gaussian(0, deviation);
  const double inclination = random.uniform(0, std::numbers::pi);
  const double azimuth = random.uniform(0, 2 * std::numbers::pi);
  const double level = length * std::sin(inclination);
  return {level * std::cos(azimuth), level * std::sin(azimuth), length * std::cos(inclination)};
}

class RangeAndBearing final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<RangeAndBearing>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    auto& list = layout.range_and_bearing;
    robot.range_and_bearing.begin = list.size();
    const scene::Devices& carried = carrier.entity.devices;
    if (!carried.range_and_bearing) return;
    const scene::RangeAndBearing& device = *carried.range_and_bearing;
    const auto& enabled = carrier.enabled.range_and_bearing;
    const auto use = enabled.value_or(scene::RangeAndBearingUse{});
    const world::Range data{list.empty() ? 0 : list.back().data.end(), device.data_size};
    list.push_back({carrier.mount(device.anchor, device.pose, layout), device.range,
                    use.medium.value_or(carried.range_and_bearing_medium.value_or(0)), data,
                    use.actuator, use.sensor});
    robot.range_and_bearing.count = enabled ? 1 : 0;
  }

  void add(const Setting& setting) override {
    const world::Layout& layout = setting.layout;
    receivers_.resize(layout.range_and_bearing.size());
    for (std::size_t r = setting.first_robot; r < layout.robots.size(); ++r) {
      const world::RobotLayout& robot = layout.robots[r];
      const auto& use = setting.enabled(robot).range_and_bearing;
      if (robot.range_and_bearing.count == 0 || !use->sensor) continue;
      const std::size_t device = robot.range_and_bearing.begin;
      const std::size_t medium = layout.range_and_bearing[device].medium;
      const bool occludes = setting.scene.media[medium].checks_occlusions;
      receivers_[device].emplace(
          Receiver{r, use->noise, use->loss, use->show_rays, occludes,
                   math::RandomStream(setting.seed, "range_and_bearing/" + robot.id)});
      needs_index_ = true;
      casts_rays_ = casts_rays_ || occludes;
    }
  }

  void sense(Tick& tick) override {
    tick.observations.range_and_bearing.clear();
    if (!needs_index_) return;
    tick.observations.range_and_bearing_data = tick.state.range_and_bearing_data;
    for (const media::Sighting& pair : medium_.sight(tick.layout, tick.index)) {
      receive(tick, pair, *receivers_[pair.receiver]);
    }
  }

  void archive(math::Archive& archive) override {
    for (auto& receiver : receivers_) {
      if (receiver) archive("random", receiver->random);
    }
  }

  bool casts_rays() const override { return casts_rays_; }
  bool needs_index() const override { return needs_index_; }

 private:
  struct Receiver {
    std::size_t robot = 0;  // into Layout::robots
    double noise = 0;       // standard deviation of the length of a sender's offset [m]
    double loss = 0;        // probability
    bool shows_rays = false;
    bool checks_occlusions = true;
    math::RandomStream random;
  };

  void receive(Tick& tick, const media::Sighting& pair, Receiver& receiver) {
    const auto& devices = tick.layout.range_and_bearing;
    const auto &from = devices[pair.sender], &to = devices[pair.receiver];
    const math::Pose own = world::pose_of(tick.state, to.mount);
    const math::Vector3 other = world::position_of(tick.state, from.mount);
    std::optional<physics::RayHit> between;
    if (receiver.checks_occlusions) {
      // The two carriers are not in their own way.
      const std::array carriers{to.mount.entity, from.mount.entity};
      between = tick.rays.cast({other, own.position, carriers, false});
    }
    tick.show({world::Ray::Kind::range_and_bearing, receiver.robot, other, own.position}, between,
              receiver.shows_rays);
    if (between) return;
    if (receiver.loss > 0 && receiver.random.uniform(0, 1) < receiver.loss) return;
    const math::Vector3 error = noise(receiver.random, receiver.noise);
    const media::Bearing bearing = media::bearing_of(math::inverse(own) * (other + error));
    tick.observations.range_and_bearing.push_back({pair.receiver, bearing.range, bearing.horizontal,
                                                   bearing.vertical, from.data, pair.sender});
  }

  media::RangeAndBearingMedium medium_;
  std::vector<std::optional<Receiver>> receivers_;  // parallel to Layout::range_and_bearing
  bool casts_rays_ = false;
  bool needs_index_ = false;
};

}  // namespace

std::unique_ptr<Kind> make_range_and_bearing() { return std::make_unique<RangeAndBearing>(); }

}  // namespace ziggurat::devices
