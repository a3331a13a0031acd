// SPDX-License-Identifier: MIT
// Wheels and turrets on the wire: what goes where, and what is refused.

#include <limits>

#include "wire/command.h"
#include "wire/device_wire.h"

namespace ziggurat::wire {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Driving : DeviceWire {
  void drive(std::vector<double> velocities) {
    command->mutable_wheel_velocities()->Add(velocities.begin(), velocities.end());
  }
  void turn(std::vector<int> modes, std::vector<double> rotations, std::vector<double> speeds) {
    for (const int mode : modes) command->add_turret_modes(static_cast<v1::TurretMode>(mode));
    command->mutable_turret_rotations()->Add(rotations.begin(), rotations.end());
    command->mutable_turret_speeds()->Add(speeds.begin(), speeds.end());
  }
  std::vector<double> wheels() const {
    std::vector<double> result;
    for (const auto& [left, right] : commands.wheels) result.insert(result.end(), {left, right});
    return result;
  }
};

TEST_F(Driving, ValuesOfAllRobots) {
  drive({1, -2, 3, 4});
  turn({v1::TURRET_SPEED, v1::TURRET_POSITION}, {0.25, 0.5}, {-1, 2});
  apply();
  EXPECT_EQ(wheels(), (std::vector<double>{1, -2, 0, 0, 3, 4})) << "no robot drives the second";
  EXPECT_EQ(commands.turret_modes[0], world::TurretMode::speed);
  EXPECT_EQ(commands.turret_modes[1], world::TurretMode::position);
  EXPECT_EQ(commands.turret_rotations[0], 0.25);
  EXPECT_EQ(commands.turret_rotations[1], 0.5);
  EXPECT_EQ(commands.turret_speeds[0], -1);
  EXPECT_EQ(commands.turret_speeds[1], 2);
}

TEST_F(Driving, RobotsThatLeftStand) {
  commands.wheels = {{1, 2}, {3, 4}, {5, 6}};
  commands.turret_modes = {world::TurretMode::speed, world::TurretMode::speed};
  commands.turret_rotations = {1, 3};
  commands.turret_speeds = {2, 4};
  reset_commands(run.layout(), 2, commands);
  EXPECT_EQ(wheels(), (std::vector<double>{1, 2, 3, 4, 0, 0}));
  EXPECT_EQ(commands.turret_speeds[0], 2);
  EXPECT_EQ(commands.turret_speeds[1], 0);
  EXPECT_EQ(commands.turret_rotations[1], 3) << "it stays where it is";
  EXPECT_EQ(commands.turret_modes[1], world::TurretMode::speed);
}

TEST_F(Driving, WrongLengths) {
  drive({1, 2, 3});
  expect_fault(ErrorCode::bad_value, "wheel_velocities", "", "is 3; it must be 4 (2 pairs");
  drive({1, 2, 3, 4, 5, 6});
  expect_fault(ErrorCode::bad_value, "wheel_velocities", "",
               "(2 pairs of wheels with an actuator, 2 values each");
  turn({v1::TURRET_SPEED}, {}, {});
  expect_fault(ErrorCode::bad_value, "turret_modes", "", "is 1; it must be 2 (2 turrets");
  turn({}, {1, 2, 3}, {});
  expect_fault(ErrorCode::bad_value, "turret_rotations", "", "(2 turrets with an actuator");
  turn({}, {}, {1});
  expect_fault(ErrorCode::bad_value, "turret_speeds", "", "is 1; it must be 2 (2 turrets");
  command->add_robots(1);
  drive({1, 2});
  expect_fault(ErrorCode::bad_value, "wheel_velocities", "", "(0 pairs");
}

TEST_F(Driving, InvalidValues) {
  drive({0, 0, 0, nan});
  expect_fault(ErrorCode::bad_value, "wheel_velocities", "c",
               "The speed of a wheel of robot 'c' is 0, nan; it must be finite.");
  drive({0, -infinity, 0, 0});
  expect_fault(ErrorCode::bad_value, "wheel_velocities", "a", "is 0, -inf");
  for (const int mode : {0, 4, -1, 2'000'000'000}) {
    turn({v1::TURRET_SPEED, mode}, {}, {});
    expect_fault(ErrorCode::bad_value, "turret_modes", "c",
                 "The turret mode of robot 'c' is " + std::to_string(mode));
  }
  command->add_robots(2);
  command->add_robots(0);
  turn({}, {0, infinity}, {});
  expect_fault(ErrorCode::bad_value, "turret_rotations", "a", "The turret rotation of robot 'a'");
  turn({}, {}, {nan, 0});
  expect_fault(ErrorCode::bad_value, "turret_speeds", "a", "The turret speed of robot 'a' is nan");
}

TEST_F(Driving, ReadingsOfThoseThatMeasure) {
  world::Observations seen = run.observations();
  seen.wheels = {{1, 1, 1, 1}, {2, 2, 2, 2}, {0.5, -0.25, 0.05, -0.025}};
  seen.turrets = {9, -3.14};
  const v1::Observation to = told(seen);
  EXPECT_EQ(std::vector<double>(to.wheels().begin(), to.wheels().end()),
            (std::vector<double>{0.5, -0.25, 0.05, -0.025}));
  ASSERT_EQ(to.turret_rotations_size(), 1);
  EXPECT_EQ(to.turret_rotations(0), -3.14);
}

TEST_F(Driving, WelcomeDescribesThem) {
  Outbox outbox;
  outbox.welcome(run.run(), roster, Welcome{"token", 0, Role::controller, 0, 0, {}});
  const auto welcome = told(outbox).welcome();
  EXPECT_FALSE(welcome.robots(1).has_wheels() || welcome.robots(1).has_turret());
  const v1::RobotDescription& a = welcome.robots(0);
  EXPECT_EQ(a.wheels().axle_length(), 0.14);
  EXPECT_TRUE(a.wheels().drives() && !a.wheels().measures());
  EXPECT_TRUE(a.turret().drives() && !a.turret().measures());
  const v1::RobotDescription& c = welcome.robots(2);
  EXPECT_EQ(c.wheels().axle_length(), 0.053);
  EXPECT_TRUE(c.wheels().drives() && c.wheels().measures());
  EXPECT_TRUE(c.turret().drives() && c.turret().measures());
}

}  // namespace
}  // namespace ziggurat::wire
