// SPDX-License-Identifier: MIT
// A rotating turret: passive, held at an angle or turned at a speed, and its encoder.

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"

namespace ziggurat::devices {
namespace {

constexpr double proportional_gain = 0.4;  // [1/s]
constexpr double derivative_gain = 0.2;

class Turrets final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Turrets>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    const scene::TurretUse use = carrier.enabled.turret.value_or(scene::TurretUse{});
    const bool enabled = carrier.entity.turret && (use.actuator || use.encoder);
    robot.turrets = append_if(enabled, layout.turrets,
                              world::TurretLayout{carrier.index, use.actuator, use.encoder});
  }

  void add(const Setting& setting) override {
    tick_length_ = setting.tick_length;
    last_errors_.resize(setting.layout.turrets.size());
  }

  void start(Tick& tick) override {
    tick.commands.turret_modes.resize(last_errors_.size(), world::TurretMode::passive);
    tick.commands.turret_rotations.resize(last_errors_.size(), 0);
    tick.commands.turret_speeds.resize(last_errors_.size(), 0);
    tick.observations.turrets.resize(last_errors_.size(), 0);
  }

  void apply(Tick& tick) override {
    for (std::size_t i = 0; i < last_errors_.size(); ++i) {
      const world::TurretLayout& layout = tick.layout.turrets[i];
      if (!layout.drives || tick.state.is_absent(layout.entity)) continue;
      const world::TurretMode mode = tick.commands.turret_modes[i];
      if (mode != world::TurretMode::position) last_errors_[i] = 0;
      switch (mode) {
        case world::TurretMode::passive:
          tick.physics.set_turret(layout.entity, {});
          break;
        case world::TurretMode::speed:
          tick.physics.set_turret(layout.entity, tick.commands.turret_speeds[i]);
          break;
        case world::TurretMode::position: {
          const double error =
              std::remainder(tick.commands.turret_rotations[i] - tick.physics.turret(layout.entity),
                             2 * std::numbers::pi);
          tick.physics.set_turret(layout.entity, approach(last_errors_[i], error));
          break;
        }
      }
    }
  }

  void sense(Tick& tick) override {
    for (std::size_t i = 0; i < last_errors_.size(); ++i) {
      const world::TurretLayout& layout = tick.layout.turrets[i];
      if (!layout.measures || tick.state.is_absent(layout.entity)) continue;
      tick.observations.turrets[i] = tick.physics.turret(layout.entity);
    }
  }

  void archive(math::Archive& archive) override { archive("last_errors", last_errors_); }

 private:
  /// The dialect's control of the angle, once per tick.
  /// @return  speed [rad/s]
  double approach(double& last_error, double error) const {
    const double change = error - std::exchange(last_error, error);
    return proportional_gain * error + derivative_gain * change / tick_length_;
  }

  double tick_length_ = 0;           // [s]
  std::vector<double> last_errors_;  // parallel to Layout::turrets; 0 unless in mode position [rad]
};

}  // namespace

std::unique_ptr<Kind> make_turrets() { return std::make_unique<Turrets>(); }

}  // namespace ziggurat::devices
