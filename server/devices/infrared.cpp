// SPDX-License-Identifier: MIT
// Proximity sensors of the e-puck with its own response: infrared light that comes back from what
// is within 5 cm.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

constexpr world::DeviceKind epuck_proximity{
    .name = "epuck_proximity", .readings = {{"value"}}, .properties = {{"angle", "rad"}}};

constexpr double range = 0.05;  // [m]

/// The dialect's curve. @param distance [m]
double response(double distance) {
  return std::clamp((298.701 * distance - 36.8961) * distance + 1.08212, 0.0, 1.0);
}

class Infrared final : public Described {
 public:
  Infrared() : Described(epuck_proximity) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Infrared>(*this); }

  bool casts_rays() const override { return !robots().empty(); }

 private:
  std::vector<double> properties(const scene::DevicePlace& place) const override {
    return {std::atan2(place.pose.position.y(), place.pose.position.x())};
  }

  void read(Tick& tick, Robot& robot) override {
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const world::DescribedDevice& device = tick.layout.described[robot.devices.begin + i];
      const math::Pose eye = world::pose_of(tick.state, device.mount);
      const math::Vector3 end = eye * math::Vector3(range, 0, 0);
      const std::array own{device.mount.entity};
      const auto hit = tick.rays.cast({eye.position, end, own, false});
      tick.show({world::Ray::Kind::device, robot.index, eye.position, end}, hit,
                robot.use.show_rays);
      const double reading = with_noise(robot, hit ? response(hit->distance) : 0);
      tick.observations.device_readings[device.readings.begin] = std::clamp(reading, 0.0, 1.0);
    }
  }
};

}  // namespace

std::unique_ptr<Kind> make_epuck_proximity() { return std::make_unique<Infrared>(); }

}  // namespace ziggurat::devices
