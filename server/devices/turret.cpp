#include "devices/turret.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace ziggurat::devices {
namespace {

constexpr double proportional_gain = 0.4;  // [1/s]
constexpr double derivative_gain = 0.2;

}  // namespace

void Turrets::add(const Setting& setting) { last_errors_.resize(setting.layout.turrets.size()); }

void Turrets::start(Tick& tick) const {
  tick.commands.turrets.resize(last_errors_.size());
  tick.observations.turrets.resize(last_errors_.size(), 0);
}

double Turrets::approach(double& last_error, double error) const {
  const double change = error - std::exchange(last_error, error);
  return proportional_gain * error + derivative_gain * change / tick_length_;
}

void Turrets::apply(Tick& tick) {
  for (std::size_t i = 0; i < last_errors_.size(); ++i) {
    const world::TurretLayout& layout = tick.layout.turrets[i];
    if (!layout.drives || tick.state.is_absent(layout.entity)) continue;
    const world::TurretCommand& command = tick.commands.turrets[i];
    if (command.mode != world::TurretMode::position) last_errors_[i] = 0;
    switch (command.mode) {
      case world::TurretMode::passive:
        tick.physics.set_turret(layout.entity, {});
        break;
      case world::TurretMode::speed:
        tick.physics.set_turret(layout.entity, command.speed);
        break;
      case world::TurretMode::position: {
        const double error = std::remainder(command.rotation - tick.physics.turret(layout.entity),
                                            2 * std::numbers::pi);
        tick.physics.set_turret(layout.entity, approach(last_errors_[i], error));
        break;
      }
    }
  }
}

void Turrets::sense(Tick& tick) const {
  for (std::size_t i = 0; i < last_errors_.size(); ++i) {
    const world::TurretLayout& layout = tick.layout.turrets[i];
    if (!layout.measures || tick.state.is_absent(layout.entity)) continue;
    tick.observations.turrets[i] = tick.physics.turret(layout.entity);
  }
}

}  // namespace ziggurat::devices
