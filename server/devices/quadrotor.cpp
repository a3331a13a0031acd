// SPDX-License-Identifier: MIT
// Flight control: a robot that flies is told a place or a velocity, a heading or a turn rate.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "devices/described.h"
#include "math/archive.h"

namespace ziggurat::devices {
namespace {

/// Meaning of a value: not at all, so that the robot stays as it is; in the world; from the pose
/// at the tick that it is set in; as a speed.
enum class FlightMode { hold, absolute, relative, speed };

/// Places of the commands. `moves` and `turns` count orders: a relative one counts anew when they
/// change.
enum FlightCommand : std::size_t {
  move_mode_at,
  x_at,
  moves_at = x_at + 3,
  velocity_at,
  turn_mode_at = velocity_at + 3,
  yaw_at,
  turns_at,
  yaw_rate_at,
  flight_commands
};

constexpr double any = std::numeric_limits<double>::infinity();
constexpr world::DeviceKind quadrotor{.name = "quadrotor",
                                      .commands = {{"move_mode", "", 0, 3},
                                                   {"x", "m"},
                                                   {"y", "m"},
                                                   {"z", "m"},
                                                   {"moves", "", -any, any},
                                                   {"velocity_x", "m/s"},
                                                   {"velocity_y", "m/s"},
                                                   {"velocity_z", "m/s"},
                                                   {"turn_mode", "", 0, 3},
                                                   {"yaw", "rad"},
                                                   {"turns", "", -any, any},
                                                   {"yaw_rate", "rad/s"}}};

class Quadrotor final : public Described {
 public:
  Quadrotor() : Described(quadrotor) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Quadrotor>(*this); }

  void archive(math::Archive& archive) override {
    Described::archive(archive);
    for (Orders& orders : before_) archive("orders", orders);
  }

 private:
  using Orders = std::array<double, flight_commands>;

  void add_robot(const Setting&) override { before_.emplace_back(); }
  void read(Tick&, Robot&) override {}

  void act(Tick& tick, std::size_t number, std::size_t entity,
           std::span<const double> commands) override {
    Orders now;
    std::ranges::copy(commands, now.begin());
    steer(now, before_[number], tick.state.origins[entity], tick.physics.flight_target(entity));
    before_[number] = now;
  }

  static FlightMode mode(double command) { return static_cast<FlightMode>(std::lround(command)); }

  /// Whether any of these orders is another one than in the last tick.
  static bool is_new(const Orders& now, const Orders& before, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last; ++i) {
      if (now[i] != before[i]) return true;
    }
    return false;
  }

  static void steer(const Orders& now, const Orders& before, const math::Pose& pose,
                    physics::FlightTarget& target) {
    const math::Vector3 place(now[x_at], now[x_at + 1], now[x_at + 2]);
    const double heading = math::heading_of(pose);
    const FlightMode move = mode(now[move_mode_at]), turn = mode(now[turn_mode_at]);
    target.holds_position = move != FlightMode::speed;
    target.velocity = {now[velocity_at], now[velocity_at + 1], now[velocity_at + 2]};
    if (move == FlightMode::absolute) target.position = place;
    if (move == FlightMode::relative && is_new(now, before, move_mode_at, moves_at)) {
      target.position = pose.position + Eigen::AngleAxisd(heading, math::Vector3::UnitZ()) * place;
    }
    if (move == FlightMode::hold && now[move_mode_at] != before[move_mode_at])
      target.position = pose.position;
    target.holds_heading = turn != FlightMode::speed;
    target.turn_rate = now[yaw_rate_at];
    if (turn == FlightMode::absolute) target.heading = now[yaw_at];
    if (turn == FlightMode::relative && is_new(now, before, turn_mode_at, turns_at))
      target.heading = heading + now[yaw_at];
    if (turn == FlightMode::hold && now[turn_mode_at] != before[turn_mode_at])
      target.heading = heading;
  }

  std::vector<Orders> before_;  // of each robot, in the last tick
};

}  // namespace

std::unique_ptr<Kind> make_quadrotor() { return std::make_unique<Quadrotor>(); }

}  // namespace ziggurat::devices
