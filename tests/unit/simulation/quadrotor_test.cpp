// SPDX-License-Identifier: MIT
// Robots that fly: hovering, flying to places and at speeds, turning, what they meet and carry.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using std::numbers::pi;
using testing::g;
using testing::ground;
using testing::SmallScene;

const std::string by_position = R"(<quadrotor_position implementation="default"/>)";
const std::string by_speed = R"(<quadrotor_speed implementation="default"/>)";

constexpr double most_acceleration = 4;  // [m/s^2]
constexpr double rate = 4;               // of the loop of speeds [1/s]

enum Mode { hold, absolute, relative, speed };

std::string flyer(const std::string& kind, const std::string& pose = R"(position="0,0,1")",
                  const std::string& attributes = "") {
  return "<" + kind + R"( id="q" )" + attributes + "><body " + pose +
         R"(/><controller config="c"/></)" + kind + ">";
}

Simulation flying(const std::string& kind = "spiri", const std::string& more = "") {
  return SmallScene{by_position + by_speed, "", flyer(kind) + more, ground}.run();
}

const math::Pose& pose(const Simulation& simulation) { return simulation.state().origins[0]; }
const math::Vector3& place(const Simulation& simulation) { return pose(simulation).position; }
double height(const Simulation& simulation) { return place(simulation).z(); }
double tilt(const Simulation& simulation) {
  return 1 - (pose(simulation).orientation * math::Vector3::UnitZ()).z();
}

void move(Simulation& simulation, Mode mode, const math::Vector3& value) {
  auto& commands = simulation.commands().device_commands;
  commands.at(0) = mode;
  for (int i = 0; i < 3; ++i) commands.at((mode == speed ? 5u : 1u) + unsigned(i)) = value[i];
}

void turn(Simulation& simulation, Mode mode, double value) {
  auto& commands = simulation.commands().device_commands;
  commands.at(8) = mode;
  commands.at(mode == speed ? 11 : 9) = value;
}

TEST(Quadrotor, HoversWhereItIsWithoutCommand) {
  for (const std::string kind : {"eye-bot", "spiri", "mini-quadrotor"}) {
    Simulation simulation = flying(kind);
    testing::run(simulation, 200);
    EXPECT_LT((place(simulation) - math::Vector3(0, 0, 1)).norm(), 1e-9) << kind;
    EXPECT_LT(tilt(simulation), 1e-12) << kind;
  }
}

TEST(Quadrotor, HoversAlsoIfNothingControlsItsFlight) {
  Simulation simulation = SmallScene{"", "", flyer("eye-bot"), ground}.run();
  testing::run(simulation, 50);
  EXPECT_LT((place(simulation) - math::Vector3(0, 0, 1)).norm(), 1e-9);
}

TEST(Quadrotor, ClimbsAtTheCommandedSpeed) {
  Simulation simulation = flying();
  move(simulation, speed, {0, 0, 0.5});
  for (int i = 1; i <= 30; ++i) {
    simulation.step();
    const double lacks = 0.5 * std::exp(-rate * 0.1 * i);
    EXPECT_NEAR(simulation.state().links[0].velocity.z(), 0.5 - lacks, 1e-9) << i;
  }
}

TEST(Quadrotor, AcceleratesWithinItsForce) {
  Simulation simulation = flying();
  move(simulation, speed, {3, 0, 0});  // asks for 12 m/s^2 at first
  for (int i = 1; i <= 4; ++i) {
    simulation.step();
    EXPECT_NEAR(simulation.state().links[0].velocity.x(), most_acceleration * 0.1 * i, 1e-9);
  }
  move(simulation, speed, {100, 0, 0});
  testing::run(simulation, 100);
  EXPECT_NEAR(simulation.state().links[0].velocity.x(), 3, 1e-9) << "its greatest speed";
  EXPECT_NEAR(height(simulation), 1, 1e-9);
}

TEST(Quadrotor, SpeedsAreAlongItsHeading) {
  Simulation simulation =
      SmallScene{by_speed, "", flyer("spiri", R"(position="0,0,1" orientation="90,0,0")"), ground}
          .run();
  move(simulation, speed, {0.5, 0.1, 0});
  testing::run(simulation, 30);
  EXPECT_NEAR(simulation.state().links[0].velocity.y(), 0.5, 1e-4);
  EXPECT_NEAR(simulation.state().links[0].velocity.x(), -0.1, 1e-4);
}

TEST(Quadrotor, FliesToAPlaceWithoutOvershoot) {
  Simulation simulation = flying();
  move(simulation, absolute, {3, -2, 2});
  for (int i = 0; i < 150; ++i) {
    simulation.step();
    EXPECT_LT(place(simulation).x(), 3 + 1e-9);
    EXPECT_LT(height(simulation), 2 + 1e-9);
  }
  EXPECT_LT((place(simulation) - math::Vector3(3, -2, 2)).norm(), 1e-5);
}

TEST(Quadrotor, ADisplacementCountsFromWhereItIs) {
  Simulation simulation =
      SmallScene{by_position, "", flyer("spiri", R"(position="1,1,1" orientation="90,0,0")"),
                 ground}
          .run();
  move(simulation, relative, {1, 0, 0.5});  // ahead is +y
  testing::run(simulation, 150);
  EXPECT_LT((place(simulation) - math::Vector3(1, 2, 1.5)).norm(), 1e-5);
  simulation.commands().device_commands.at(4) += 1;  // once more
  testing::run(simulation, 150);
  EXPECT_LT((place(simulation) - math::Vector3(1, 3, 2)).norm(), 1e-5);
}

TEST(Quadrotor, HoldsWhereItIsOnceToldTo) {
  Simulation simulation = flying();
  move(simulation, speed, {0, 0, 1});
  testing::run(simulation, 10);
  const double from = height(simulation);
  move(simulation, hold, {0, 0, 0});
  testing::run(simulation, 150);
  EXPECT_NEAR(height(simulation), from, 1e-5);
}

TEST(Quadrotor, Turns) {
  Simulation simulation = flying();
  turn(simulation, absolute, 2);
  testing::run(simulation, 100);
  EXPECT_NEAR(math::heading_of(pose(simulation)), 2, 1e-6);
  turn(simulation, relative, 1);
  testing::run(simulation, 100);
  EXPECT_NEAR(math::heading_of(pose(simulation)), 3, 1e-6);
  turn(simulation, speed, -0.5);
  testing::run(simulation, 20);
  EXPECT_NEAR(simulation.state().links[0].angular_velocity.z(), -0.5, 1e-6);
  EXPECT_LT((place(simulation) - math::Vector3(0, 0, 1)).norm(), 1e-9);
}

TEST(Quadrotor, StopsAtAWall) {
  const std::string wall =
      R"(<box id="wall" size="0.1,9,3" movable="false"><body position="1.05,0,0"/></box>)";
  Simulation simulation = flying("spiri", wall);
  move(simulation, absolute, {3, 0, 1});
  testing::run(simulation, 100);
  EXPECT_NEAR(place(simulation).x(), 0.8, 5e-3);  // its radius is 0.2
  EXPECT_NEAR(height(simulation), 1, 0.05);
  EXPECT_LT(tilt(simulation), 0.01);
}

TEST(Quadrotor, RightsItselfAndStartsFromTheFloor) {
  Simulation simulation =
      SmallScene{by_position, "", flyer("eye-bot", R"(position="0,0,1" orientation="0,0,60")"),
                 ground}
          .run();
  testing::run(simulation, 100);
  EXPECT_LT(tilt(simulation), 1e-9);
  Simulation low = SmallScene{by_position, "", flyer("eye-bot", ""), ground}.run();
  testing::run(low, 20);
  EXPECT_NEAR(height(low), 0, 1e-3);
  move(low, absolute, {0, 0, 1});
  testing::run(low, 150);
  EXPECT_NEAR(height(low), 1, 1e-5);
}

TEST(Quadrotor, ASnapshotGoesOnAsBefore) {
  const scene::Scene scene = SmallScene{by_position, "", flyer("spiri"), ground}.read();
  Simulation simulation(scene, {1});
  move(simulation, relative, {1, 0, 0});
  testing::run(simulation, 5);
  const Snapshot snapshot = simulation.snapshot();
  testing::run(simulation, 20);
  const std::uint64_t expected = simulation.hash();
  simulation.restore(scene, snapshot);
  testing::run(simulation, 20);
  EXPECT_EQ(simulation.hash(), expected);
  testing::run(simulation, 150);
  EXPECT_NEAR(place(simulation).x(), 1, 1e-5) << "the displacement is not taken again";
}

TEST(Quadrotor, StaysWhereADirectorPutsIt) {
  Simulation simulation = flying();
  testing::run(simulation, 5);
  simulation.move(0, {math::Vector3(2, 0, 2), math::Quaternion::Identity()});
  testing::run(simulation, 50);
  EXPECT_LT((place(simulation) - math::Vector3(2, 0, 2)).norm(), 1e-9);
}

TEST(EyeBot, SeesWhatIsBelowAndAround) {
  const std::string sensors = R"(<eyebot_proximity implementation="default"/>)"
                              R"(<eyebot_light implementation="rot_z_only"/>)"
                              R"(<positioning implementation="default"/>)"
                              R"(<battery implementation="default"/>)"
                              R"(<range_and_bearing implementation="medium" medium="rab"/>)"
                              R"(<colored_blob_perspective_camera implementation="default" )"
                              R"(medium="leds"/>)";
  const std::string things =
      R"(<light id="l" position="0.1,0.05,0" color="red" intensity="0" medium="leds"/>)"
      R"(<box id="wall" size="0.1,0.01,3" movable="false"><body position="1.3,0.16,0"/></box>)";
  const std::string eye_bot =
      R"(<eye-bot id="q"><body position="0,0,1"/><controller config="c"/><battery/></eye-bot>)";
  const std::string actuators = by_speed + R"(<leds implementation="default" medium="leds"/>)";
  Simulation simulation = SmallScene{actuators, sensors, eye_bot + things, ground}.run();
  ASSERT_EQ(simulation.commands().led_colors.size(), 34u) << "33, and that of the light";
  for (std::size_t i = 0; i < simulation.layout().described.size(); ++i) {
    const auto& device = simulation.layout().described[i];
    if (device.kind->name == std::string("colored_blob_perspective_camera"))
      simulation.commands().device_commands.at(device.commands.begin) = 1;
  }
  simulation.step();
  // A ray at 7.5 degrees meets the wall's side at x = 1.25.
  const double distance = 1.25 / std::cos(7.5 * pi / 180) - 0.255;
  ASSERT_EQ(simulation.observations().proximity.size(), 24u);
  EXPECT_NEAR(simulation.observations().proximity[0], 0.0100527 / (distance + 0.000163144), 1e-5);
  EXPECT_EQ(simulation.observations().proximity[12], 0);
  const auto& blobs = simulation.observations().device_rows.at(0);
  ASSERT_EQ(blobs.count(), 1u);
  // Ahead of the robot is up in the picture, its left is left. 30 degrees are 400 px.
  const double pixels = 400 / std::tan(pi / 6);
  EXPECT_EQ(blobs.values[0], std::trunc(320 - 0.05 * pixels));
  EXPECT_EQ(blobs.values[1], std::trunc(240 - 0.1 * pixels));
}

}  // namespace
}  // namespace ziggurat::simulation
