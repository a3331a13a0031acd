// SPDX-License-Identifier: MIT
// Rangefinders: the distance to the nearest body along a ray.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

/// A reading is the range if there is nothing nearer.
constexpr world::DeviceKind rangefinders{
    .name = "rangefinders", .readings = {{"proximity", "m"}}, .properties = {{"range", "m"}}};

/// Nearer than the nearest that it can tell, it reads that.
constexpr world::DeviceKind ultrasound{.name = "kheperaiv_ultrasound",
                                       .readings = {{"distance", "m"}},
                                       .properties = {{"angle", "rad"}}};

/// Settings of a place: the range, and the least distance that is told, if that is not 0 [m].
class Rangefinders final : public Described {
 public:
  explicit Rangefinders(const world::DeviceKind& kind) : Described(kind) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Rangefinders>(*this); }

  bool casts_rays() const override { return !robots().empty(); }

 private:
  std::vector<double> properties(const scene::DevicePlace& place) const override {
    if (&kind() == &rangefinders) return {place.settings[0]};
    return {std::atan2(place.pose.position.y(), place.pose.position.x())};
  }

  void read(Tick& tick, Robot& robot) override {
    const std::array own{tick.layout.robots[robot.index].entity};
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const world::DescribedDevice& device = tick.layout.described[robot.devices.begin + i];
      const std::vector<double>& settings = robot.places[i].settings;
      const double range = settings[0], nearest = settings.size() > 1 ? settings[1] : 0;
      const math::Pose eye = world::pose_of(tick.state, device.mount);
      const math::Vector3 end = eye * math::Vector3(range, 0, 0);
      const auto hit = tick.rays.cast({eye.position, end, own, true});
      tick.show({world::Ray::Kind::device, robot.index, eye.position, end}, hit,
                robot.use.show_rays);
      tick.observations.device_readings[device.readings.begin] =
          std::clamp(with_noise(robot, hit ? hit->distance : range), nearest, range);
    }
  }
};

}  // namespace

std::unique_ptr<Kind> make_rangefinders() { return std::make_unique<Rangefinders>(rangefinders); }
std::unique_ptr<Kind> make_ultrasound() { return std::make_unique<Rangefinders>(ultrasound); }

}  // namespace ziggurat::devices
