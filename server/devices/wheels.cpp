// SPDX-License-Identifier: MIT
// Two driven wheels: speeds that are commanded, and what an encoder makes of them.

#include <array>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

double draw(math::RandomStream& random, double mean, double deviation) {
  return deviation > 0 ? random.gaussian(mean, deviation) : mean;
}

double draw(math::RandomStream& random, const scene::NoiseRange& noise) {
  return noise.min < noise.max ? random.uniform(noise.min, noise.max) : noise.min;
}

class Wheels final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Wheels>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    const auto& use = carrier.enabled.wheels;
    const auto& axle_length = carrier.entity.axle_length;
    robot.wheels.begin = layout.wheels.size();
    if (!use || !axle_length) return;
    layout.wheels.push_back({carrier.index, *axle_length, use->actuator, use->sensor});
    robot.wheels.count = 1;
  }

  void add(const Setting& setting) override {
    tick_length_ = setting.tick_length;
    for (const world::RobotLayout& robot : setting.new_robots()) {
      if (robot.wheels.count == 0) continue;
      Axle axle{*setting.enabled(robot).wheels,
                math::RandomStream(setting.seed, "wheels/" + robot.id),
                math::RandomStream(setting.seed, "wheel_encoders/" + robot.id),
                {},
                {}};
      for (std::size_t side = 0; side < 2; ++side) {
        const scene::WheelNoise& noise = axle.use.noise[side];
        axle.bias[side] = draw(axle.driving, noise.bias_mean, noise.bias_deviation);
      }
      axles_.push_back(std::move(axle));
    }
  }

  void start(Tick& tick) override {
    tick.commands.wheels.resize(axles_.size());
    tick.observations.wheels.resize(axles_.size());
  }

  void apply(Tick& tick) override {
    for (std::size_t i = 0; i < axles_.size(); ++i) {
      const world::WheelsLayout& layout = tick.layout.wheels[i];
      if (!layout.drives || tick.state.is_absent(layout.entity)) continue;
      Axle& axle = axles_[i];
      const world::WheelsCommand& command = tick.commands.wheels[i];
      axle.velocity = {command.left, command.right};
      const bool stands = command.left == 0 && command.right == 0;  // a motor without voltage
      for (std::size_t side = 0; side < 2 && !stands; ++side) {
        const scene::WheelNoise& noise = axle.use.noise[side];
        axle.velocity[side] = (axle.velocity[side] + axle.bias[side]) *
                              draw(axle.driving, noise.factor_mean, noise.factor_deviation);
      }
      const auto& [left, right] = axle.velocity;
      tick.physics.set_velocity(layout.entity, (left + right) / 2,
                                (right - left) / layout.axle_length);
    }
  }

  void sense(Tick& tick) override {
    for (std::size_t i = 0; i < axles_.size(); ++i) {
      const world::WheelsLayout& layout = tick.layout.wheels[i];
      if (!layout.measures || tick.state.is_absent(layout.entity)) continue;
      Axle& axle = axles_[i];
      const auto& [left, right] = axle.velocity;
      world::WheelsReading& reading = tick.observations.wheels[i];
      reading.velocity_left = left + draw(axle.measuring, axle.use.velocity_noise);
      reading.velocity_right = right + draw(axle.measuring, axle.use.velocity_noise);
      reading.distance_left = left * tick_length_ + draw(axle.measuring, axle.use.distance_noise);
      reading.distance_right = right * tick_length_ + draw(axle.measuring, axle.use.distance_noise);
    }
  }

  void archive(math::Archive& archive) override {
    for (Axle& axle : axles_) {
      archive("driving", axle.driving);
      archive("measuring", axle.measuring);
      archive("bias", axle.bias);
      archive("velocity", axle.velocity);
    }
  }

 private:
  struct Axle {
    scene::WheelsUse use;  // its noise
    math::RandomStream driving, measuring;
    std::array<double, 2> bias{};      // [m/s]
    std::array<double, 2> velocity{};  // of the wheels in this tick [m/s]
  };

  double tick_length_ = 0;   // [s]
  std::vector<Axle> axles_;  // parallel to Layout::wheels
};

}  // namespace

std::unique_ptr<Kind> make_wheels() { return std::make_unique<Wheels>(); }

}  // namespace ziggurat::devices
