// SPDX-License-Identifier: MIT
// Ground truth: the pose of a robot's origin in the world, with noise where asked for.

#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

bool is_silent(const scene::NoiseRange& noise) { return noise.min == 0 && noise.max == 0; }

math::Vector3 draw(const scene::NoiseRange& noise, math::RandomStream& random) {
  math::Vector3 offset;
  for (double& coordinate : offset) coordinate = random.uniform(noise.min, noise.max);
  return offset;
}

class Positioning final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Positioning>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    robot.positioning =
        append_if(carrier.enabled.positioning.has_value(), layout.positioning, carrier.index);
  }

  void add(const Setting& setting) override {
    for (const world::RobotLayout& robot : setting.new_robots()) {
      if (robot.positioning.count == 0) continue;
      const scene::PositioningUse& use = *setting.enabled(robot).positioning;
      sensors_.push_back({use, math::RandomStream(setting.seed, "positioning/" + robot.id)});
    }
  }

  /// New sensors sense at once.
  void start(Tick& tick) override {
    const std::size_t known = tick.observations.positioning.size();
    tick.observations.positioning.resize(sensors_.size());
    sense(tick, known);
  }

  void sense(Tick& tick) override { sense(tick, 0); }

  void archive(math::Archive& archive) override {
    for (Sensor& sensor : sensors_) archive("random", sensor.random);
  }

 private:
  void sense(Tick& tick, std::size_t first) {
    std::vector<math::Pose>& poses = tick.observations.positioning;
    for (std::size_t i = first; i < sensors_.size(); ++i) {
      Sensor& sensor = sensors_[i];
      math::Pose pose = tick.state.origins[tick.layout.positioning[i]];
      if (!is_silent(sensor.noise.position))
        pose.position += draw(sensor.noise.position, sensor.random);
      if (!is_silent(sensor.noise.angle) || !is_silent(sensor.noise.axis)) {
        const Eigen::AngleAxisd turn(pose.orientation);
        const double angle =
            turn.angle() + sensor.random.uniform(sensor.noise.angle.min, sensor.noise.angle.max);
        math::Vector3 axis = turn.axis();
        if (!is_silent(sensor.noise.axis)) axis += draw(sensor.noise.axis, sensor.random);
        if (axis.norm() < 1e-12) axis = turn.axis();  // the noise took it away
        pose.orientation = Eigen::AngleAxisd(angle, axis.normalized());
      }
      poses[i] = {pose.position, math::canonical(pose.orientation)};
    }
  }

  struct Sensor {
    scene::PositioningUse noise;
    math::RandomStream random;
  };
  std::vector<Sensor> sensors_;  // parallel to Layout::positioning
};

}  // namespace

std::unique_ptr<Kind> make_positioning() { return std::make_unique<Positioning>(); }

}  // namespace ziggurat::devices
