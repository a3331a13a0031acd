// SPDX-License-Identifier: MIT
// Robots on wheels: how they drive, push and turn their turrets, and what they read of it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::ground;
using testing::SmallScene;
using testing::wheels;
using world::TurretMode;

constexpr double axle = 0.14;  // [m]

std::string foot_bot(const std::string& pose = "", const std::string& more = "",
                     const std::string& attributes = "") {
  return R"(<foot-bot id="fb" )" + attributes + "><body " + pose + R"(/><controller config="c"/>)" +
         more + "</foot-bot>";
}

double yaw(const math::Pose& pose) {
  const math::Vector3 x = pose.orientation * math::Vector3::UnitX();
  return std::atan2(x.y(), x.x());
}

/// The first robot's wheels [m/s].
void drive(Simulation& simulation, double left, double right) {
  simulation.commands().wheels.at(0) = {left, right};
}

/// The first robot's turret. @param value  [rad] or [rad/s], as the mode says
void turn(Simulation& simulation, TurretMode mode, double value) {
  world::Commands& commands = simulation.commands();
  commands.turret_modes.at(0) = mode;
  commands.turret_rotations.at(0) = mode == TurretMode::position ? value : 0;
  commands.turret_speeds.at(0) = mode == TurretMode::speed ? value : 0;
}

TEST(FootBot, TurnsOnTheSpotAsTheClosedFormSays) {
  Simulation simulation = SmallScene{wheels, "", foot_bot(), ground}.run();
  drive(simulation, 0.0025, -0.0025);
  for (int i = 0; i < 1000; ++i) simulation.step();
  const double expected = -0.005 / axle * 100;
  EXPECT_NEAR(yaw(simulation.state().origins[0]), std::remainder(expected, 2 * std::numbers::pi),
              1e-4);
  EXPECT_LT(simulation.state().origins[0].position.head<2>().norm(), 1e-6);
  EXPECT_NEAR(simulation.state().origins[0].position.z(), 0, 1e-4);
}

TEST(FootBot, DrivesAnArcThatIsExactOnceItHasGatheredSpeed) {
  Simulation simulation = SmallScene{wheels, "", foot_bot(), ground}.run();
  drive(simulation, 0.1, 0.2);
  simulation.step();
  const math::Pose start = simulation.state().origins[0];
  // 15 N on 1.6 kg: the first substep of 50 ms gives it all of 0.15 m/s.
  const double turn = 0.1 / axle, radius = 0.15 / turn;
  EXPECT_NEAR(start.position.x(), radius * std::sin(turn * 0.1), 1e-9);
  EXPECT_NEAR(start.position.y(), radius * (1 - std::cos(turn * 0.1)), 1e-9);
  EXPECT_NEAR(yaw(start), turn * 0.1, 1e-9);
  for (int i = 1; i < 500; ++i) simulation.step();
  const math::Pose& pose = simulation.state().origins[0];
  EXPECT_NEAR(pose.position.x(), radius * std::sin(turn * 50), 1e-6);
  EXPECT_NEAR(pose.position.y(), radius * (1 - std::cos(turn * 50)), 1e-6);
  EXPECT_NEAR(yaw(pose), std::remainder(turn * 50, 2 * std::numbers::pi), 1e-6);
}

TEST(FootBot, GathersSpeedWithinItsForceLimit) {
  const std::string weak =
      R"(<dynamics2d><differential_steering max_force="0.8" max_torque="1"/></dynamics2d>)";
  Simulation simulation = SmallScene{wheels, "", foot_bot("", weak), ground}.run();
  drive(simulation, 1, 1);
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_NEAR(simulation.state().links[0].velocity.x(), 0.5, 1e-9);  // 0.8 N / 1.6 kg * 1 s
}

TEST(FootBot, ZeroSpeedBrakesIt) {
  Simulation simulation = SmallScene{wheels, "", foot_bot(), ground}.run();
  drive(simulation, 0.2, 0.2);
  for (int i = 0; i < 10; ++i) simulation.step();
  simulation.commands().wheels[0] = {};
  simulation.step();
  EXPECT_LT(simulation.state().links[0].velocity.norm(), 1e-9);
}

std::string box_ahead(const std::string& x, const std::string& mass) {
  return R"(<box id="box" size="0.2,0.2,0.1" movable="true" mass=")" + mass +
         R"("><body position=")" + x + R"(,0,0"/></box>)";
}

TEST(FootBot, PushesWithItsForceAndNotMore) {
  // Friction of the box with the floor: 0.25 * 9.8 N/kg * m; a foot-bot has 15 N.
  const auto pushed = [](const std::string& mass) {
    Simulation simulation =
        SmallScene{wheels, "", foot_bot() + box_ahead("0.2", mass), ground}.run();
    drive(simulation, 0.1, 0.1);
    for (int i = 0; i < 50; ++i) simulation.step();
    EXPECT_NEAR(simulation.state().links[0].pose.position.z(), 0, 1e-3);
    return simulation.state().origins[1].position.x() - 0.2;
  };
  EXPECT_GT(pushed("4"), 0.4);    // 9.8 N
  EXPECT_LT(pushed("8"), 0.005);  // 19.6 N
}

TEST(FootBot, StopsAtAWallAndStaysUpright) {
  const std::string wall =
      R"(<box id="wall" size="0.1,2,0.05" movable="false"><body position="0.3,0,0"/></box>)";
  Simulation simulation = SmallScene{wheels, "", foot_bot() + wall, ground}.run();
  drive(simulation, 0.3, 0.3);
  for (int i = 0; i < 50; ++i) simulation.step();
  const math::Pose& pose = simulation.state().origins[0];
  EXPECT_NEAR(pose.position.x(), 0.25 - 0.085036758, 1e-3);
  EXPECT_NEAR((pose.orientation * math::Vector3::UnitZ()).z(), 1, 1e-12);
}

TEST(FootBot, MeetsAnotherOne) {
  const std::string other = R"(<foot-bot id="g"><body position="0.5,0,0" orientation="180,0,0"/>)"
                            R"(<controller config="c"/></foot-bot>)";
  Simulation simulation = SmallScene{wheels, "", foot_bot() + other, ground}.run();
  simulation.commands().wheels = {{0.1, 0.1}, {0.1, 0.1}};
  for (int i = 0; i < 60; ++i) simulation.step();
  const auto& origins = simulation.state().origins;
  EXPECT_NEAR(origins[0].position.x() + origins[1].position.x(), 0.5, 1e-3);
  EXPECT_NEAR(origins[1].position.x() - origins[0].position.x(), 2 * 0.085036758, 1e-3);
}

TEST(FootBot, FallsOntoTheFloorAndDrivesOn) {
  Simulation simulation = SmallScene{wheels, "", foot_bot("position=\"0,0,0.1\""), ground}.run();
  drive(simulation, 0.1, 0.1);
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_NEAR(simulation.state().origins[0].position.z(), 0, 1e-3);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.2, 1e-2);
}

TEST(FootBot, StaysWhereItIsIfItMayNotMove) {
  Simulation simulation = SmallScene{wheels + R"(<footbot_turret implementation="default"/>)", "",
                                     foot_bot("", "", "movable=\"false\""), ground}
                              .run();
  drive(simulation, 0.1, 0.1);
  turn(simulation, TurretMode::speed, 0.5);
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_EQ(simulation.state().origins[0].position, math::Vector3::Zero());
  EXPECT_NEAR(yaw(simulation.state().links[1].pose), 0.5, 1e-9);
}

TEST(Plane, HoldsRobotsAtItsElevation) {
  SmallScene scene{wheels, "", foot_bot("position=\"0,0,2\""), ground};
  std::string text = scene.str();
  const std::string engines = "<physics_engines>";
  text.insert(text.find(engines) + engines.size(), R"(<dynamics2d id="flat" elevation="2"/>)");
  const scene::ReadResult read = scene::read_text(text, "plane.argos");
  ASSERT_TRUE(read.ok());
  Simulation simulation(read.scene, {1});
  simulation.commands().wheels.at(0) = {0.1, 0.1};
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_NEAR(simulation.state().origins[0].position.z(), 2, 1e-12);
  EXPECT_NEAR(simulation.state().origins[0].position.x(), 0.1, 1e-9);
}

TEST(Plane, AloneBrakesWhatIsPushed) {
  // The ground brakes the box with 1.49 N: more than 1 N and less than 2 N.
  const auto pushed = [](const std::string& force) {
    SmallScene scene{wheels, "",
                     foot_bot("", R"(<dynamics2d><differential_steering max_force=")" + force +
                                      R"("/></dynamics2d>)") +
                         box_ahead("0.185037", "1"),
                     ""};
    std::string text = scene.str();
    text.replace(text.find(R"(<dynamics3d id="d" iterations="2"></dynamics3d>)"), 47,
                 R"(<dynamics2d id="flat" iterations="10"/>)");
    const scene::ReadResult read = scene::read_text(text, "plane.argos");
    EXPECT_TRUE(read.ok());
    Simulation simulation(read.scene, {1});
    simulation.commands().wheels.at(0) = {0.05, 0.05};
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(simulation.state().origins[1].position.z(), 0);
    return simulation.state().origins[1].position.x() - 0.185037;
  };
  EXPECT_LT(pushed("1.4"), 1e-3);
  EXPECT_GT(pushed("2"), 0.3);
}

// --- turret -------------------------------------------------------------------------------------

constexpr const char* turret = R"(<footbot_turret implementation="default"/>)";
constexpr const char* encoder = R"(<footbot_turret_encoder implementation="default"/>)";

TEST(Turret, TurnsWithTheRobotUntilToldOtherwise) {
  Simulation simulation = SmallScene{wheels + turret, encoder, foot_bot(), ground}.run();
  drive(simulation, -0.01, 0.01);
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_NEAR(yaw(simulation.state().links[1].pose), 0.02 / axle * 2, 1e-9);
  EXPECT_EQ(simulation.observations().turrets.at(0), 0);
}

TEST(Turret, TurnsAtItsSpeedOnTopOfTheRobots) {
  Simulation simulation = SmallScene{wheels + turret, encoder, foot_bot(), ground}.run();
  drive(simulation, -0.01, 0.01);
  const double rate = 2 * std::numbers::pi / 30;  // 2 RPM
  turn(simulation, TurretMode::speed, rate);
  simulation.step();
  EXPECT_NEAR(simulation.observations().turrets.at(0), 0.0209439510, 1e-9);
  EXPECT_NEAR(simulation.state().links[1].angular_velocity.z(), rate + 0.02 / axle, 1e-9);
  for (int i = 1; i < 200; ++i) simulation.step();
  EXPECT_NEAR(simulation.observations().turrets[0], std::remainder(rate * 20, 2 * std::numbers::pi),
              1e-6);
  EXPECT_NEAR(yaw(simulation.state().links[1].pose),
              std::remainder((rate + 0.02 / axle) * 20, 2 * std::numbers::pi), 1e-6);
}

TEST(Turret, ApproachesItsAngleByTheDialectsFormula) {
  Simulation simulation = SmallScene{turret, encoder, foot_bot(), ground}.run();
  turn(simulation, TurretMode::position, 0.5);
  double angle = 0, last = 0;
  for (int i = 0; i < 30; ++i) {
    const double error = 0.5 - angle;
    angle += (0.4 * error + 0.2 * (error - last) / 0.1) * 0.1;
    last = error;
    simulation.step();
    EXPECT_NEAR(simulation.observations().turrets.at(0), angle, 1e-9);
  }
  turn(simulation, TurretMode::passive, 0);
  for (int i = 0; i < 5; ++i) simulation.step();
  EXPECT_NEAR(simulation.observations().turrets[0], angle, 1e-12);
}

// --- readings -----------------------------------------------------------------------------------

TEST(WheelEncoders, ReadWhatWasCommanded) {
  Simulation simulation = SmallScene{wheels, wheels, foot_bot(), ground}.run();
  drive(simulation, 0.1, 0.2);
  EXPECT_EQ(simulation.observations().wheels.at(0).velocity_left, 0);
  simulation.step();
  const world::WheelsReading& reading = simulation.observations().wheels[0];
  EXPECT_EQ(reading.velocity_left, 0.1);
  EXPECT_EQ(reading.velocity_right, 0.2);
  EXPECT_NEAR(reading.distance_left, 0.01, 1e-15);
  EXPECT_NEAR(reading.distance_right, 0.02, 1e-15);
}

TEST(WheelNoise, BiasIsDrawnOnceAndTheFactorEveryTick) {
  const auto speeds = [](const std::string& noise, std::uint64_t seed) {
    Simulation simulation =
        SmallScene{R"(<differential_steering implementation="default" )" + noise + "/>", wheels,
                   foot_bot(), ground}
            .run(seed);
    simulation.commands().wheels.at(0) = {0.1, 0.1};
    std::vector<double> read;
    for (int i = 0; i < 5; ++i) {
      simulation.step();
      read.push_back(simulation.observations().wheels[0].velocity_left);
    }
    return read;
  };
  const auto biased = speeds(R"(bias_avg="0.01" bias_stddev="0.001")", 3);
  EXPECT_EQ(biased[0], biased[4]);
  EXPECT_NE(biased[0], 0.11);
  EXPECT_NEAR(biased[0], 0.11, 0.006);
  EXPECT_NE(biased, speeds(R"(bias_avg="0.01" bias_stddev="0.001")", 4));
  const auto scaled = speeds(R"(factor_stddev="0.1")", 3);
  EXPECT_NE(scaled[0], scaled[1]);
  EXPECT_EQ(scaled, speeds(R"(factor_stddev="0.1")", 3));
  EXPECT_NEAR(speeds(R"(factor_avg="2" factor_avg_left="3" bias_avg_left="0.1")", 3)[0], 0.6,
              1e-12);
}

TEST(WheelNoise, DoesNotMoveARobotThatIsToldToStand) {
  Simulation simulation =
      SmallScene{R"(<differential_steering implementation="default" bias_avg="0.1"/>)", wheels,
                 foot_bot(), ground}
          .run();
  testing::run(simulation, 5);
  EXPECT_EQ(simulation.observations().wheels.at(0).velocity_left, 0);
  EXPECT_EQ(simulation.state().origins.at(0).position.x(), 0);
  simulation.commands().wheels.at(0) = {0, 0.1};
  simulation.step();
  EXPECT_NEAR(simulation.observations().wheels[0].velocity_left, 0.1, 1e-15);
}

TEST(WheelEncoders, HaveUniformNoiseInCentimetres) {
  Simulation simulation =
      SmallScene{wheels,
                 R"(<differential_steering implementation="default" vel_noise_range="1:3")"
                 R"( dist_noise_range="-0.2:0.6"/>)",
                 foot_bot(), ground}
          .run();
  simulation.commands().wheels.at(0) = {0.1, 0.1};
  math::Vector2 sum = math::Vector2::Zero();
  math::Vector2 least = math::Vector2::Constant(1), most = math::Vector2::Constant(-1);
  constexpr int ticks = 1000;
  for (int i = 0; i < ticks; ++i) {
    simulation.step();
    const world::WheelsReading& reading = simulation.observations().wheels[0];
    const math::Vector2 error(reading.velocity_left - 0.1, reading.distance_right - 0.01);
    sum += error;
    least = least.cwiseMin(error);
    most = most.cwiseMax(error);
  }
  EXPECT_GE(least.x(), 0.01 - 1e-12);
  EXPECT_LE(most.x(), 0.03 + 1e-12);
  EXPECT_GE(least.y(), -0.002 - 1e-12);
  EXPECT_LE(most.y(), 0.006 + 1e-12);
  const double four = 4 / std::sqrt(12.0 * ticks);  // deviations of a mean, of a span of 1
  EXPECT_NEAR(sum.x() / ticks, 0.02, 0.02 * four);
  EXPECT_NEAR(sum.y() / ticks, 0.002, 0.008 * four);
}

TEST(FootBotProximity, ReadsItsOwnResponseWithTheAngle) {
  const std::string sensor = R"(<footbot_proximity implementation="default"/>)";
  // Sensor 1 looks along 7.5 degrees; the wall is 50 mm away in x.
  const double radius = 0.085036758, slope = std::cos(7.5 * std::numbers::pi / 180);
  const std::string wall = R"(<box id="w" size="0.1,2,1" movable="false"><body position=")" +
                           std::to_string(0.05 + 0.05 + radius) + R"(,0,0"/></box>)";
  const SmallScene scene{"", sensor, foot_bot() + wall, ground};
  Simulation simulation = scene.run();
  const auto& layout = simulation.layout().proximity;
  ASSERT_EQ(layout.size(), 24u);
  EXPECT_NEAR(layout[0].angle.value(), 7.5 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(layout[23].angle.value(), -7.5 * std::numbers::pi / 180, 1e-12);
  simulation.step();
  const double distance = (0.05 + radius) / slope - radius;
  EXPECT_NEAR(simulation.observations().proximity[0], 0.0100527 / (distance + 0.000163144), 1e-5);
  EXPECT_EQ(simulation.observations().proximity[12], 0);
}

TEST(FootBotProximity, PlainSensorHasNoAngleAndReadsTheExponential) {
  const std::string wall =
      R"(<box id="w" size="0.1,2,1" movable="false"><body position="0.185,0,0"/></box>)";
  Simulation simulation =
      SmallScene{"", R"(<proximity implementation="default"/>)", foot_bot() + wall, ground}.run();
  EXPECT_FALSE(simulation.layout().proximity.at(0).angle);
  simulation.step();
  EXPECT_GT(simulation.observations().proximity[0], 0.9);
}

TEST(EPuck, DrivesOnItsOwnAxle) {
  Simulation simulation =
      SmallScene{wheels, R"(<proximity implementation="default"/>)",
                 R"(<e-puck id="e"><body/><controller config="c"/></e-puck>)", ground}
          .run();
  simulation.commands().wheels.at(0) = {-0.01, 0.01};
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_NEAR(yaw(simulation.state().origins[0]), 0.02 / 0.053, 1e-9);
  EXPECT_EQ(simulation.observations().proximity.size(), 8u);
}

TEST(Robots, AreDistributedByTheirCylinders) {
  const std::string group =
      R"(<distribute><position method="uniform" min="-0.5,-0.5,0" max="0.5,0.5,0"/>)"
      R"(<orientation method="uniform" min="0,0,0" max="360,0,0"/>)"
      R"(<entity quantity="12" max_trials="500"><foot-bot id="fb"><controller config="c"/>)"
      R"(</foot-bot></entity></distribute>)";
  Simulation simulation = SmallScene{wheels, "", group, ground}.run();
  const auto& origins = simulation.state().origins;
  ASSERT_EQ(origins.size(), 12u);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    for (std::size_t k = i + 1; k < origins.size(); ++k) {
      EXPECT_GE((origins[i].position - origins[k].position).norm(), 2 * 0.085036758 - 1e-6);
    }
  }
}

}  // namespace
}  // namespace ziggurat::simulation
