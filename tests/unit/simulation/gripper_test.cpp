// SPDX-License-Identifier: MIT
// Grippers: what they hold, pull and turn; the force at which a grip tears; what ends it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "simulation/snapshot.h"
#include "small_scene.h"

namespace ziggurat::simulation::grippers {
namespace {

using math::Vector3;
using std::numbers::pi;
using testing::SmallScene;

constexpr double radius = 0.085036758;  // of the robot [m]
constexpr double half_box = 0.05;       // [m]
const std::string turret = R"(<footbot_turret implementation="default"/>)";

std::string gripper(double max_force = 10'000, const std::string& name = "footbot_gripper") {
  return "<" + name + R"( implementation="default" max_force=")" + std::to_string(max_force) +
         R"("/>)";
}

std::string robot(const std::string& attributes = "") {
  return R"(<foot-bot id="fb" )" + attributes + R"(><body/><controller config="c"/></foot-bot>)";
}

/// A box of 10 cm and 0.5 kg in front of the robot.
/// @param gap  between both [m]
std::string box(double gap = 0.001,
                const std::string& attributes = R"(movable="true" mass="0.5")") {
  return R"(<box id="box" size="0.1,0.1,0.1" )" + attributes + R"(><body position=")" +
         std::to_string(radius + half_box + gap) + R"(,0,0"/></box>)";
}

SmallScene scene(const std::string& arena, const std::string& actuators = gripper()) {
  return {testing::wheels + actuators, "", arena};
}

void lock(Simulation& simulation, bool wanted = true) {
  simulation.commands().device_commands.back() = wanted ? 1 : 0;
}

void drive(Simulation& simulation, double left, double right) {
  simulation.commands().wheels.at(0) = {left, right};
}

bool grips(const Simulation& simulation) {
  return simulation.observations().device_readings.back() == 1;
}

const math::Pose& pose(const Simulation& simulation, std::size_t entity) {
  return simulation.state().origins.at(entity);
}

/// Position of the box in the robot's frame.
Vector3 seen(const Simulation& simulation) {
  return math::inverse(pose(simulation, 0)) * pose(simulation, 1).position;
}

void pull(Simulation& simulation, const Vector3& force, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    simulation.commands().pushes = {{simulation.layout().entities[1].links.begin, force}};
    simulation.step();
  }
}

TEST(Gripper, PullsABoxAlong) {
  Simulation simulation = scene(robot() + box()).run();
  lock(simulation);
  simulation.step();
  ASSERT_TRUE(grips(simulation));
  const Vector3 at = seen(simulation);
  drive(simulation, -0.1, -0.1);
  testing::run(simulation, 50);
  EXPECT_LT(pose(simulation, 0).position.x(), -0.45);
  EXPECT_NEAR(seen(simulation).x(), at.x(), 1e-5);
  EXPECT_NEAR(seen(simulation).y(), 0, 1e-5);
  EXPECT_TRUE(grips(simulation));
}

TEST(Gripper, LeavesWhatItUnlocks) {
  Simulation simulation = scene(robot() + box()).run();
  lock(simulation);
  simulation.step();
  drive(simulation, -0.1, -0.1);
  testing::run(simulation, 10);
  drive(simulation, 0, 0);
  testing::run(simulation, 5);
  lock(simulation, false);
  simulation.step();
  EXPECT_FALSE(grips(simulation));
  const double x = pose(simulation, 1).position.x();
  drive(simulation, -0.1, -0.1);
  testing::run(simulation, 10);
  EXPECT_NEAR(pose(simulation, 1).position.x(), x, 1e-4);
}

TEST(Gripper, HoldsOnFirstContactWhatItWasLockedBefore) {
  Simulation simulation = scene(robot() + box(0.05)).run();
  lock(simulation);
  testing::run(simulation, 3);
  EXPECT_FALSE(grips(simulation));
  drive(simulation, 0.1, 0.1);
  testing::run(simulation, 6);
  EXPECT_TRUE(grips(simulation));
}

// The wheels hold the robot, so a steady pull is the whole force in the grip.
TEST(Gripper, TearsAboveItsForce) {
  constexpr double limit = 5;  // [N]
  Simulation holds = scene(robot() + box(), gripper(limit)).run();
  Simulation tears = scene(robot() + box(), gripper(limit)).run();
  for (Simulation* each : {&holds, &tears}) {
    lock(*each);
    each->step();
  }
  pull(holds, {0.99 * limit, 0, 0}, 30);
  pull(tears, {1.01 * limit, 0, 0}, 30);
  EXPECT_TRUE(grips(holds));
  EXPECT_NEAR(seen(holds).x(), radius + half_box + 0.001, 1e-4);
  EXPECT_FALSE(grips(tears));
  EXPECT_GT(seen(tears).x(), 1);
}

TEST(Gripper, TearsByTheWholeForceNotByItsParts) {
  constexpr double limit = 5;  // [N]; upwards the robot yields, 1.6 kg of 2.1: 3.4 N
  Simulation tears = scene(robot() + box(), gripper(limit)).run();
  lock(tears);
  tears.step();
  pull(tears, {4.5, 0, 4.5}, 5);
  EXPECT_FALSE(grips(tears));
}

TEST(Gripper, HoldsAgainWhatItToreFromOnceItWasUnlocked) {
  Simulation simulation = scene(robot() + box(), gripper(0.5)).run();
  lock(simulation);
  simulation.step();
  pull(simulation, {-2, 2, 0}, 1);  // pressed to the robot, it stays
  simulation.step();
  ASSERT_FALSE(grips(simulation));
  simulation.move(1, {{radius + half_box, 0, 0}, math::Quaternion::Identity()});
  lock(simulation, false);
  simulation.step();
  lock(simulation);
  simulation.step();
  EXPECT_TRUE(grips(simulation));
}

TEST(Gripper, TurnsWithATurretThatIsDriven) {
  Simulation simulation = scene(robot() + box(0.005), turret + gripper()).run();
  lock(simulation);
  simulation.step();
  simulation.commands().turret_modes.at(0) = world::TurretMode::speed;
  simulation.commands().turret_speeds.at(0) = 0.2;  // [rad/s]
  testing::run(simulation, 50);
  // The middle of the face that is held; the box turns about it.
  const Vector3 at =
      math::inverse(pose(simulation, 0)) * (pose(simulation, 1) * Vector3(-half_box, 0, 0));
  EXPECT_NEAR(std::atan2(at.y(), at.x()), 1, 0.05);
  EXPECT_NEAR(std::hypot(at.x(), at.y()), radius + 0.005, 1e-3);
  EXPECT_TRUE(grips(simulation));
}

TEST(Gripper, LetsTheRobotTurnUnderATurretThatIsNot) {
  Simulation simulation = scene(robot() + box(0.005)).run();
  lock(simulation);
  simulation.step();
  const Vector3 before = pose(simulation, 1).position;
  drive(simulation, -0.05, 0.05);
  testing::run(simulation, 20);
  const double yaw = std::remainder(
      2 * std::atan2(pose(simulation, 0).orientation.z(), pose(simulation, 0).orientation.w()),
      2 * pi);
  EXPECT_NEAR(yaw, 20 * 0.1 * 0.1 / 0.14, 0.05);
  EXPECT_LT((pose(simulation, 1).position - before).norm(), 1e-3);
  EXPECT_TRUE(grips(simulation));
}

TEST(Gripper, HoldsOnlyWhatAllowsIt) {
  const auto prototype = [](const std::string& attributes) {
    return R"(<prototype id="box" )" + attributes + R"(><body position="0.14,0,0"/>)" +
           R"(<links ref="l"><link id="l" geometry="box" size="0.1,0.1,0.1" mass="0.5"/></links>)" +
           "</prototype>";
  };
  const std::string cylinder =
      R"(<cylinder id="box" radius="0.05" height="0.1" movable="true" mass="1">)"
      R"(<body position="0.14,0,0"/></cylinder>)";
  const std::pair<std::string, bool> cases[] = {
      {box(), true},
      {box(0.001, R"(movable="false")"), false},
      {box(0.001, R"(movable="true" mass="1" grippable="false")"), false},
      {box(0.0095), true},
      {box(0.0105), false},
      {cylinder, true},
      {prototype(""), false},
      {prototype(R"(grippable="true")"), true},
  };
  for (const auto& [arena, expected] : cases) {
    Simulation simulation = scene(robot() + arena).run();
    lock(simulation);
    simulation.step();
    EXPECT_EQ(grips(simulation), expected) << arena;
  }
}

TEST(Gripper, OfAFixedRobotHoldsNothing) {
  Simulation simulation = scene(robot(R"(movable="false")") + box()).run();
  lock(simulation);
  simulation.step();
  EXPECT_FALSE(grips(simulation));
}

TEST(Gripper, HoldsFootBotsButNotEPucks) {
  for (const char* kind : {"foot-bot", "e-puck"}) {
    const std::string name(kind);
    const double at = radius + 0.002 + (name == "e-puck" ? 0.035 : radius);
    SmallScene with =
        scene(robot() + "<" + name + R"( id="other"><body position=")" + std::to_string(at) +
              R"(,0,0"/><controller config="d"/></)" + name + ">");
    std::string text = with.str();
    text.insert(
        text.find("</controllers>"),
        R"(<external_controller id="d"><actuators/><sensors/><params/></external_controller>)");
    Simulation simulation(scene::read_text(text, "small.argos").scene, {1});
    lock(simulation);
    simulation.step();
    EXPECT_EQ(grips(simulation), name == "foot-bot") << name;
  }
}

TEST(Gripper, EndsWithWhatItHoldsAndWhenThatIsMoved) {
  for (const bool removes : {true, false}) {
    Simulation simulation = scene(robot() + box()).run();
    lock(simulation);
    simulation.step();
    ASSERT_TRUE(grips(simulation));
    if (removes) {
      simulation.remove(1);
    } else {
      simulation.move(1, {{2, 0, 0}, math::Quaternion::Identity()});
    }
    testing::run(simulation, 3);
    EXPECT_FALSE(grips(simulation));
  }
}

TEST(Gripper, SleepsAndWakesWithWhatItHolds) {
  SmallScene resting = scene(robot() + box());
  resting.engine = testing::ground;
  Simulation simulation = resting.run();
  lock(simulation);
  testing::run(simulation, 100);
  ASSERT_TRUE(grips(simulation));
  const Vector3 at = seen(simulation);
  drive(simulation, -0.1, -0.1);
  testing::run(simulation, 30);
  EXPECT_LT(pose(simulation, 0).position.x(), -0.25);
  EXPECT_NEAR(seen(simulation).x(), at.x(), 1e-4);
}

// Bonded magnets take their substeps in parts, and with them the robot that holds one.
TEST(Gripper, PullsMagnetsThatAreBonded) {
  const auto block = [](const std::string& id, const std::string& x, const std::string& magnet) {
    return "<prototype id=\"" + id + R"(" grippable="true"><body position=")" + x +
           R"(,0,0"/><links ref="l"><link id="l" geometry="box" size="0.05,0.05,0.05" mass="0.1"/>)" +
           R"(</links><devices><magnets><magnet anchor="l" offset=")" + magnet +
           R"(,0,0.025" passive_field="650,0,0"/></magnets></devices></prototype>)";
  };
  SmallScene magnetic =
      scene(robot() + block("near", "0.1105", "0.015") + block("far", "0.1606", "-0.015"));
  magnetic.engine = testing::ground + std::string("<magnetism/>");
  Simulation simulation = magnetic.run();
  lock(simulation);
  testing::run(simulation, 5);
  ASSERT_TRUE(grips(simulation));
  drive(simulation, -0.05, -0.05);
  testing::run(simulation, 40);
  EXPECT_LT(pose(simulation, 0).position.x(), -0.18);
  EXPECT_NEAR(pose(simulation, 1).position.x() - pose(simulation, 0).position.x(), 0.1105, 2e-3);
  EXPECT_NEAR(pose(simulation, 2).position.x() - pose(simulation, 1).position.x(), 0.05, 1e-3);
}

TEST(Gripper, IsPartOfTheState) {
  SmallScene resting = scene(robot() + box(), gripper(20));
  resting.engine = testing::ground;
  const scene::Scene read = resting.read();
  Simulation simulation(read, {1});
  lock(simulation);
  testing::run(simulation, 3);
  drive(simulation, -0.08, -0.1);
  testing::run(simulation, 7);
  ASSERT_TRUE(grips(simulation));
  Snapshot snapshot = simulation.snapshot();
  snapshot.is_checked = false;  // as if it was read from a file
  testing::run(simulation, 20);
  Simulation again(read, {1});
  again.restore(read, snapshot);
  testing::run(again, 20);
  EXPECT_EQ(again.hash(), simulation.hash());
}

}  // namespace
}  // namespace ziggurat::simulation::grippers
