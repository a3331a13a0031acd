// SPDX-License-Identifier: MIT
// The two vibration motors of a kilobot, and their calibration.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "devices/described.h"
#include "math/archive.h"

namespace ziggurat::devices {
namespace {

/// The properties are what a kilobot remembers of its calibration: the values at which it turns and
/// goes straight at its nominal speeds.
constexpr world::DeviceKind kilobot_motors{
    .name = "kilobot_differential_drive",
    .commands = {{"left", "", 0, 255}, {"right", "", 0, 255}},
    .properties = {{"turn_left"}, {"turn_right"}, {"straight_left"}, {"straight_right"}}};

/// The calibration of motors of usual strength; speeds are proportional to the values.
constexpr double usual_turn = 70, usual_straight = 65;
constexpr double straight_speed = 0.01;                  // [m/s]
constexpr double one_sided_turn = std::numbers::pi / 4;  // with one motor [rad/s]

/// The left motor alone turns to the left, about the leg on that side, the right one to the right;
/// both drive ahead.
class KilobotMotors final : public Described {
 public:
  KilobotMotors() : Described(kilobot_motors) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<KilobotMotors>(*this); }

  void archive(math::Archive& archive) override {
    Described::archive(archive);
    for (std::uint8_t& ran : ran_) archive("ran", ran);
  }

 private:
  void add_robot(const Setting&) override { ran_.push_back(0); }
  void read(Tick&, Robot&) override {}

  /// While both motors stand, <differential_steering> may drive.
  void act(Tick& tick, std::size_t number, std::size_t entity,
           std::span<const double> commands) override {
    const double left = commands[0], right = commands[1];
    const bool runs = left > 0 || right > 0;
    if (runs || ran_[number])
      drive(tick.physics, entity, robots()[number].places[0].settings, left, right);
    ran_[number] = runs;
  }

  std::vector<double> properties(const scene::DevicePlace& place) const override {
    const double left = place.settings[0], right = place.settings[1];
    return {usual_turn / left, usual_turn / right, usual_straight / left, usual_straight / right};
  }

  /// @param settings  strength of the left and the right motor, distance of the legs [m]
  static void drive(physics::World& physics, std::size_t entity,
                    const std::vector<double>& settings, double left, double right) {
    left *= settings[0];
    right *= settings[1];
    if (left > 0 && right > 0) {
      physics.set_velocity(entity, straight_speed * (left + right) / 2 / usual_straight,
                           one_sided_turn * (left - right) / usual_straight);
    } else {
      const double turn = one_sided_turn * (left - right) / usual_turn;
      physics.set_velocity(entity, std::abs(turn) * settings[2] / 2, turn);
    }
  }

  std::vector<std::uint8_t> ran_;  // each robot, in the last tick
};

}  // namespace

std::unique_ptr<Kind> make_kilobot_motors() { return std::make_unique<KilobotMotors>(); }

}  // namespace ziggurat::devices
