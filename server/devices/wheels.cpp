#include "devices/wheels.h"

namespace ziggurat::devices {
namespace {

double draw(math::RandomStream& random, double mean, double deviation) {
  return deviation > 0 ? random.gaussian(mean, deviation) : mean;
}

double draw(math::RandomStream& random, const scene::NoiseRange& noise) {
  return noise.min < noise.max ? random.uniform(noise.min, noise.max) : noise.min;
}

}  // namespace

void Wheels::add(const Setting& setting) {
  for (const world::RobotLayout& robot : setting.new_robots()) {
    if (robot.wheels.count == 0) continue;
    const scene::ControllerDevices& enabled = setting.enabled(robot);
    Axle axle{enabled.wheel_noise,
              enabled.wheel_velocity_noise,
              enabled.wheel_distance_noise,
              math::RandomStream(setting.seed, "wheels/" + robot.id),
              math::RandomStream(setting.seed, "wheel_encoders/" + robot.id),
              {},
              {}};
    for (std::size_t side = 0; side < 2; ++side) {
      const scene::WheelNoise& noise = axle.noise[side];
      axle.bias[side] = draw(axle.driving, noise.bias_mean, noise.bias_deviation);
    }
    axles_.push_back(std::move(axle));
  }
}

void Wheels::start(Tick& tick) const {
  tick.commands.wheels.resize(axles_.size());
  tick.observations.wheels.resize(axles_.size());
}

void Wheels::apply(Tick& tick) {
  for (std::size_t i = 0; i < axles_.size(); ++i) {
    const world::WheelsLayout& layout = tick.layout.wheels[i];
    if (!layout.drives || tick.state.is_absent(layout.entity)) continue;
    Axle& axle = axles_[i];
    const world::WheelsCommand& command = tick.commands.wheels[i];
    axle.velocity = {command.left, command.right};
    for (std::size_t side = 0; side < 2; ++side) {
      const scene::WheelNoise& noise = axle.noise[side];
      axle.velocity[side] = (axle.velocity[side] + axle.bias[side]) *
                            draw(axle.driving, noise.factor_mean, noise.factor_deviation);
    }
    const auto& [left, right] = axle.velocity;
    tick.physics.set_velocity(layout.entity, (left + right) / 2,
                              (right - left) / layout.axle_length);
  }
}

void Wheels::sense(Tick& tick) {
  for (std::size_t i = 0; i < axles_.size(); ++i) {
    const world::WheelsLayout& layout = tick.layout.wheels[i];
    if (!layout.measures || tick.state.is_absent(layout.entity)) continue;
    Axle& axle = axles_[i];
    const auto& [left, right] = axle.velocity;
    world::WheelsReading& reading = tick.observations.wheels[i];
    reading.velocity_left = left + draw(axle.measuring, axle.velocity_noise);
    reading.velocity_right = right + draw(axle.measuring, axle.velocity_noise);
    reading.distance_left = left * tick_length_ + draw(axle.measuring, axle.distance_noise);
    reading.distance_right = right * tick_length_ + draw(axle.measuring, axle.distance_noise);
  }
}

}  // namespace ziggurat::devices
