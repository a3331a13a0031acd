// SPDX-License-Identifier: MIT
// Entities that are spawned while a world runs, and entities that are removed.

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "small_scene.h"
#include "words_of.h"

namespace ziggurat::simulation {
namespace {

using testing::Base;
using testing::gravity;
using testing::robot;
using testing::SmallScene;
using testing::wheels;

std::string box(const std::string& id, const std::string& position, Base base = Base::free) {
  return "<box id=\"" + id + R"(" size=".1,.1,.1" mass="1" movable=")" +
         (base == Base::free ? "true" : "false") + "\"><body position=\"" + position + "\"/></box>";
}

std::string tag(const std::string& payload) {
  return R"(<tags medium="tags"><tag anchor="base" position="0,0,0.1" orientation="0,0,0" )"
         R"(observable_angle="90" side_length="0.05" payload=")" +
         payload + "\"/></tags>";
}

/// A scene and a world of it.
class World {
 public:
  explicit World(const SmallScene& small) : read_(small.read_all()), simulation(read_.scene, {1}) {}

  void spawn(const std::string& xml) {
    const auto& entities = simulation.layout().entities;
    const scene::Addition addition =
        read_.additions.read(xml, read_.scene, 1 << 20, [&](const std::string& id) {
          for (std::size_t i = 0; i < entities.size(); ++i) {
            if (entities[i].id == id && !simulation.state().is_absent(i)) return true;
          }
          return false;
        });
    for (const auto& problem : addition.problems) ADD_FAILURE() << scene::to_string(problem);
    simulation.spawn(read_.scene, addition.entity);
  }
  void step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) simulation.step();
  }
  void reset() { simulation.reset(read_.scene, {1}); }

 private:
  scene::ReadResult read_;

 public:
  Simulation simulation;
};

TEST(Spawn, ABoxFallsFromWhereItIsPlaced) {
  World world({"", "", box("a", "0,0,5"), gravity});
  world.step(3);
  world.spawn(box("b", "1,0,4"));
  EXPECT_EQ(world.simulation.layout().entities.at(1).id, "b");
  EXPECT_EQ(world.simulation.state().origins.at(1).position, math::Vector3(1, 0, 4));
  world.step();
  EXPECT_NEAR(world.simulation.state().origins[1].position.z(), 4 - 10 * 0.1 * 0.1 / 2, 1e-12);
}

TEST(Move, AStateThatIsNotFiniteIsAFaultThatNamesTheEntity) {
  World world({"", "", box("a", "0,0,5") + box("b", "1,0,5"), gravity});
  math::Pose pose = world.simulation.state().origins[1];
  pose.position.x() = std::numeric_limits<double>::infinity();
  world.simulation.move(1, pose);
  const std::string words = words_of<std::runtime_error>([&] { world.step(); });
  EXPECT_TRUE(words.starts_with("tick 1: the pose or velocity of 'b' is not")) << words;
}

/// Boxes of 0.1 m, one of which moves.
TEST(Move, APlaceIsFreeWhereNothingIsOverlapped) {
  World world({"", "", box("a", "0,0,0") + box("b", "1,0,0", Base::fixed), gravity + "<floor/>"});
  const Simulation& simulation = world.simulation;
  const auto overlapped = [&](std::size_t entity, double x, double z) {
    math::Pose pose = simulation.state().origins[entity];
    pose.position = {x, 0, z};
    return overlapped_by(simulation, simulation.entities()[entity], pose, entity);
  };
  EXPECT_EQ(overlapped(0, 0.95, 0), std::optional<std::size_t>(1));
  EXPECT_EQ(overlapped(0, 0.9, 0), std::nullopt) << "it touches";
  EXPECT_EQ(overlapped(0, 0.901, 0), std::optional<std::size_t>(1)) << "by 1 mm";
  EXPECT_EQ(overlapped(0, 1, 0.1), std::nullopt) << "it stands on b";
  EXPECT_EQ(overlapped(0, 0.01, 0), std::nullopt) << "it is where it was itself";
  EXPECT_EQ(overlapped(0, 0.5, -0.05), std::nullopt) << "the floor does not count";
  world.step(10);
  EXPECT_EQ(overlapped(0, simulation.state().origins[0].position.x(),
                       simulation.state().origins[0].position.z()),
            std::nullopt)
      << "what rests may stay";
}

/// A body that lies on another one overlaps it a little.
TEST(Move, WhatRestsOnOthersMayStayAndComeBack) {
  World world({"", "", box("a", "0,0,0") + box("b", "0,0,0.1"), gravity + "<floor/>"});
  world.step(20);
  const Simulation& simulation = world.simulation;
  EXPECT_EQ(overlapped_by(simulation, simulation.entities()[1], simulation.state().origins[1], 1),
            std::nullopt);
}

TEST(Spawn, WhereSomethingStandsIsRefusedAndChangesNothing) {
  World world({"", "", box("a", "0,0,5", Base::fixed), gravity}),
      other({"", "", box("a", "0,0,5", Base::fixed), gravity});
  world.step(3);
  other.step(3);
  const std::string words =
      words_of<scene::SceneError>([&] { world.spawn("\n" + box("b", "0.05,0,5")); });
  EXPECT_EQ(words, "spawn:2:1: 'b' overlaps 'a' where it is placed; choose a place that is free");
  EXPECT_EQ(world.simulation.layout().entities.size(), 1u);
  world.step(3);
  other.step(3);
  EXPECT_EQ(world.simulation.hash(), other.simulation.hash());
}

TEST(Spawn, IsDeterministicAndGoneAfterAReset) {
  const SmallScene small{"", "<positioning implementation=\"default\"/>",
                         box("a", "0,0,0.5") + robot("r", "2,0,0.3", tag("7")),
                         gravity + "<floor/>"};
  World one(small), two(small), fresh(small);
  for (World* world : {&one, &two}) {
    world->step(4);
    world->spawn(robot("s", "0.02,0,0.9", tag("8"), "10,20,30"));
    world->step(2);
    world->simulation.remove(0);
    world->step(10);
  }
  EXPECT_EQ(one.simulation.hash(), two.simulation.hash());
  one.reset();
  EXPECT_EQ(one.simulation.layout().entities.size(), 2u);
  EXPECT_EQ(one.simulation.layout().robots.size(), 1u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(one.simulation.hash(), fresh.simulation.hash()) << "tick " << i;
    one.step();
    fresh.step();
  }
}

TEST(Spawn, ChangesTheHashAtOnceAndSoDoesRemove) {
  World world({"", "", box("a", "0,0,5"), gravity}), other({"", "", box("a", "0,0,5"), gravity});
  world.spawn(box("b", "1,0,4"));
  EXPECT_NE(world.simulation.hash(), other.simulation.hash());
  const auto before = world.simulation.hash();
  world.simulation.remove(1);
  EXPECT_NE(world.simulation.hash(), before);
}

const std::string camera =
    R"(<cameras implementation="default"><camera id="eye" anchor="base" position="0,0,0.2" )"
    R"(orientation="0,0,0" range="0.01:3" resolution="640,480" focal_length="400,400" )"
    R"(principle_point="320,240"><tag_detector medium="tags"/><led_detector medium="leds"/>)"
    R"(</camera></cameras>)";

TEST(Spawn, ATagIsSeenAtTheNextTickAndNoMoreOnceItIsRemoved) {
  World world({"", camera, robot("r", "0,0,0", ""), ""});
  world.step(2);
  // Its tag faces down, one metre above the camera, which looks up.
  world.spawn(robot("s", "0,0,1.3", tag("8"), "0,180,0"));
  EXPECT_TRUE(world.simulation.observations().tags.empty());
  world.step();
  const auto& seen = world.simulation.observations().tags;
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].camera, 0u);
  EXPECT_EQ(world.simulation.state().tag_payloads.at(seen[0].tag), "8");
  world.simulation.remove(1);
  world.step();
  EXPECT_TRUE(world.simulation.observations().tags.empty());
}

TEST(Spawn, ARobotSensesWhatIsThere) {
  World world({"", camera, robot("r", "0,0,1.3", tag("7"), "0,180,0"), ""});
  world.step(2);
  world.simulation.remove(0);
  world.spawn(robot("t", "0,0,1.3", tag("9"), "0,180,0"));
  world.spawn(robot("s", "0,0,0", ""));
  world.step();
  const auto& seen = world.simulation.observations().tags;
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].camera, 2u) << "of the robot that came last; the tag's own looks away";
  EXPECT_EQ(world.simulation.state().tag_payloads.at(seen[0].tag), "9");
}

const std::string photographer =
    R"(<cameras implementation="default"><camera id="eye" anchor="base" position="0,0,0.2" )"
    R"(orientation="0,0,0" range="0.01:3" resolution="64,48" focal_length="40,40" )"
    R"(principle_point="32,24" image="true"/></cameras>)";

TEST(Spawn, IsInPicturesAndTakesThem) {
  // The first camera of the world comes late: what is there already is in its pictures.
  World world({"", photographer, box("a", "0,0,1.5", Base::fixed), ""});
  world.step();
  world.spawn(robot("r", "0,0,0", ""));
  const auto& images = world.simulation.observations().images;
  ASSERT_EQ(images.size(), 1u);
  EXPECT_TRUE(images[0].rgb.empty()) << "as at tick 0";
  world.step();
  const auto with_a = images[0].rgb;
  ASSERT_EQ(with_a.size(), 64u * 48 * 3);
  world.spawn(box("b", "0.3,0,1.5"));
  world.step();
  EXPECT_NE(images[0].rgb, with_a);
  world.simulation.remove(2);
  world.step();
  EXPECT_EQ(images[0].rgb, with_a);
  world.simulation.remove(0);
  world.step();
  EXPECT_NE(images[0].rgb, with_a);
  world.spawn(robot("s", "1,0,0", ""));
  world.simulation.remove(1);
  world.step();
  ASSERT_EQ(images.size(), 2u);
  EXPECT_TRUE(images[0].rgb.empty()) << "it is not there";
  EXPECT_FALSE(images[1].rgb.empty());
}

const std::string radio =
    R"(<radios medium="air"><radio anchor="base" position="0,0,0" range="3"/></radios>)";

std::vector<std::size_t> hearers(Simulation& simulation, std::size_t sender) {
  const std::uint8_t hello[] = {1};
  simulation.commands().radio_messages.add(sender, hello);
  simulation.step();
  std::vector<std::size_t> radios;
  for (const auto& entry : simulation.observations().radio_messages.entries) {
    radios.push_back(entry.radio);
  }
  return radios;
}

TEST(Spawn, RadiosReachEachOtherWhilePresent) {
  World world({R"(<radios implementation="default"/>)", R"(<radios implementation="default"/>)",
               robot("r", "0,0,0", radio) + robot("q", "1,0,0", radio), ""});
  EXPECT_EQ(hearers(world.simulation, 0), (std::vector<std::size_t>{1}));
  world.spawn(robot("s", "0,1,0", radio));
  EXPECT_EQ(hearers(world.simulation, 0), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(hearers(world.simulation, 2), (std::vector<std::size_t>{0, 1}));
  world.simulation.remove(1);
  EXPECT_EQ(hearers(world.simulation, 2), (std::vector<std::size_t>{0}));
  EXPECT_EQ(hearers(world.simulation, 1), (std::vector<std::size_t>{})) << "it is not there";
  const std::uint8_t last[] = {1};
  world.simulation.commands().radio_messages.add(2, last);
  world.simulation.remove(2);
  world.step();
  EXPECT_TRUE(world.simulation.observations().radio_messages.entries.empty());
}

TEST(Spawn, RangeAndBearingReachesWhilePresent) {
  const std::string device =
      R"(<range_and_bearing anchor="base" position="0,0,0.2" range="3" data_size="2" medium="rab"/>)";
  World world({R"(<range_and_bearing implementation="default"/>)",
               R"(<range_and_bearing implementation="medium" medium="rab"/>)",
               robot("r", "0,0,0", device), ""});
  world.spawn(robot("s", "0,1,0", device));
  world.simulation.commands().range_and_bearing_data[3] = 9;
  world.step();
  const auto& packets = world.simulation.observations().range_and_bearing;
  ASSERT_EQ(packets.size(), 2u);
  EXPECT_EQ(packets[0].receiver, 0u);
  EXPECT_NEAR(packets[0].range, 1, 1e-12);
  EXPECT_EQ(world.simulation.observations().range_and_bearing_data.at(packets[0].data.begin + 1),
            9);
  world.simulation.remove(0);
  world.step();
  EXPECT_TRUE(packets.empty());
}

TEST(Spawn, LeavesWhatOthersCommandForTheTickInHand) {
  const SmallScene small{
      R"(<leds implementation="default" medium="leds"/>)", "",
      robot("r", "0,0,0",
            R"(<leds medium="leds"><led anchor="base" offset="0,0,0" color="red"/></leds>)"),
      ""};
  World world(small);
  world.step();
  world.simulation.commands().led_colors[0] = 0x00FF00;
  const auto before = world.simulation.state().led_colors;
  world.spawn(
      robot("s", "3,0,0",
            R"(<leds medium="leds"><led anchor="base" offset="0,0,0" color="blue"/></leds>)"));
  EXPECT_EQ(world.simulation.state().led_colors, (std::vector<world::Color>{0xFF0000, 0x0000FF}))
      << "nothing is applied before the tick";
  world.step();
  EXPECT_EQ(world.simulation.state().led_colors, (std::vector<world::Color>{0x00FF00, 0x0000FF}));
}

TEST(Spawn, AFootBotIsDrivenAndItsPlacesStayWhenItIsRemoved) {
  const auto foot_bot = [](const std::string& id, const std::string& at) {
    return "<foot-bot id=\"" + id + "\"><body position=\"" + at +
           "\"/><controller config=\"c\"/></foot-bot>";
  };
  World world({wheels + R"(<footbot_turret implementation="default"/>)",
               wheels + R"(<footbot_turret_encoder implementation="default"/><footbot_proximity )"
                        R"(implementation="default"/><positioning implementation="default"/>)",
               foot_bot("a", "0,0,0"), gravity + "<floor/>"});
  world.step();
  world.spawn(foot_bot("b", "2,0,0"));
  ASSERT_EQ(world.simulation.commands().wheels.size(), 2u);
  EXPECT_EQ(world.simulation.observations().positioning.at(1).position.x(), 2);
  for (auto& command : world.simulation.commands().wheels) command = {0.2, 0.2};
  world.step(10);
  EXPECT_NEAR(world.simulation.state().origins[1].position.x(), 2.2, 0.005);
  EXPECT_NEAR(world.simulation.observations().positioning[1].position.x(), 2.2, 0.005);
  const auto where = world.simulation.state().origins[1].position;
  world.simulation.remove(1);
  world.simulation.commands().turret_modes[1] = world::TurretMode::speed;
  world.simulation.commands().turret_speeds[1] = 1;
  world.step(10);
  EXPECT_EQ(world.simulation.state().origins[1].position, where);
  EXPECT_NEAR(world.simulation.state().origins[0].position.x(), 0.4, 0.01);
  world.spawn(foot_bot("b", "2.2,0,0"));
  EXPECT_EQ(world.simulation.layout().robots.size(), 3u) << "a name may come again";
}

TEST(Remove, OfASupportLetsFallWhatStoodOnIt) {
  World world({"", "", box("a", "0,0,0", Base::fixed) + box("b", "0,0,0.1"), gravity + "<floor/>"});
  world.step(50);
  ASSERT_NEAR(world.simulation.state().origins[1].position.z(), 0.1, 1e-4);
  world.simulation.remove(0);
  world.step(50);
  EXPECT_NEAR(world.simulation.state().origins[1].position.z(), 0, 1e-3);
}

TEST(Remove, OfAJointedRobotLeavesItsReadings) {
  const std::string arm =
      R"(<prototype id="p" movable="false"><body position="1,0,2"/><links ref="base">)"
      R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)"
      R"(<link id="arm" geometry="box" size=".5,.1,.1" mass="1"/></links><joints>)"
      R"(<joint id="hinge" type="revolute" axis="0,1,0"><parent link="base" position="0,0,0"/>)"
      R"(<child link="arm" position="-.25,0,0"/></joint></joints><controller config="c"/></prototype>)";
  World world(
      {R"(<joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="1"/></joints>)",
       R"(<joints implementation="default"><joint id="hinge" mode="position"/></joints>)", arm,
       ""});
  world.simulation.commands().joint_targets[0] = 1;
  world.step(5);
  EXPECT_GT(world.simulation.observations().joint_readings[0], 0.3);
  world.simulation.remove(0);
  world.step(5);
  EXPECT_EQ(world.simulation.observations().joint_readings.size(), 1u);
}

}  // namespace
}  // namespace ziggurat::simulation
