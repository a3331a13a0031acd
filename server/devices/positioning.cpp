#include "devices/positioning.h"

namespace ziggurat::devices {
namespace {

bool is_silent(const scene::NoiseRange& noise) { return noise.min == 0 && noise.max == 0; }

math::Vector3 draw(const scene::NoiseRange& noise, math::RandomStream& random) {
  math::Vector3 offset;
  for (double& coordinate : offset) coordinate = random.uniform(noise.min, noise.max);
  return offset;
}

}  // namespace

void Positioning::add(const Setting& setting) {
  for (const world::RobotLayout& robot : setting.new_robots()) {
    if (robot.positioning.count == 0) continue;
    const scene::ControllerDevices& enabled = setting.enabled(robot);
    sensors_.push_back({enabled.position_noise, enabled.angle_noise, enabled.axis_noise,
                        math::RandomStream(setting.seed, "positioning/" + robot.id)});
  }
}

void Positioning::start(Tick& tick) {
  const std::size_t known = tick.observations.positioning.size();
  tick.observations.positioning.resize(sensors_.size());
  sense(tick, known);
}

void Positioning::sense(Tick& tick, std::size_t first) {
  std::vector<math::Pose>& poses = tick.observations.positioning;
  for (std::size_t i = first; i < sensors_.size(); ++i) {
    Sensor& sensor = sensors_[i];
    math::Pose pose = tick.state.origins[tick.layout.positioning[i]];
    if (!is_silent(sensor.position)) pose.position += draw(sensor.position, sensor.random);
    if (!is_silent(sensor.angle) || !is_silent(sensor.axis)) {
      const Eigen::AngleAxisd turn(pose.orientation);
      const double angle = turn.angle() + sensor.random.uniform(sensor.angle.min, sensor.angle.max);
      math::Vector3 axis = turn.axis();
      if (!is_silent(sensor.axis)) axis += draw(sensor.axis, sensor.random);
      if (axis.norm() < 1e-12) axis = turn.axis();  // the noise took it away
      pose.orientation = Eigen::AngleAxisd(angle, axis.normalized());
    }
    poses[i] = pose;
  }
}

}  // namespace ziggurat::devices
