// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::SmallScene;
using Messages = std::vector<std::pair<std::size_t, std::string>>;  // radio, text

constexpr const char* both = R"(<radios implementation="default"/>)";
constexpr const char* showing = R"(<radios implementation="default" show_rays="true"/>)";

std::string with_radio(const std::string& range = "1") {
  return R"(<radios medium="air"><radio anchor="base" position="0,0,0" range=")" + range +
         R"("/></radios>)";
}

void send(Simulation& simulation, std::size_t radio, const std::string& text) {
  simulation.commands().radio_messages.add(radio,
                                           std::vector<std::uint8_t>(text.begin(), text.end()));
}

Messages received(const Simulation& simulation) {
  Messages messages;
  const auto& all = simulation.observations().radio_messages;
  for (const auto& entry : all.entries) {
    const auto payload = all.payload(entry);
    messages.emplace_back(entry.radio, std::string(payload.begin(), payload.end()));
  }
  return messages;
}

SmallScene three_robots() {
  return {both, both,
          testing::robot("a", "0,0,0", with_radio()) +
              testing::robot("b", "0.5,0,0", with_radio()) +
              testing::robot("c", "1,0,0", with_radio("0.6")),
          ""};
}

TEST(Radio, IsHeardInTheNextTickAndOnlyThere) {
  Simulation simulation = three_robots().run();
  send(simulation, 2, "x");
  EXPECT_TRUE(received(simulation).empty());
  simulation.step();
  EXPECT_EQ(received(simulation), (Messages{{1, "x"}}));
  EXPECT_TRUE(simulation.commands().radio_messages.entries.empty());
  simulation.step();
  EXPECT_TRUE(received(simulation).empty());
}

TEST(Radio, GivesTheSameHashWhateverTheOrderOfAnswers) {
  Simulation first = three_robots().run(), second = three_robots().run();
  send(first, 0, "a");
  send(first, 2, "c");
  send(second, 2, "c");
  send(second, 0, "a");
  first.step();
  second.step();
  EXPECT_EQ(received(first), (Messages{{1, "a"}, {1, "c"}}));
  EXPECT_EQ(first.hash(), second.hash());
}

TEST(Radio, ChangesTheHash) {
  Simulation first = three_robots().run(), second = three_robots().run();
  send(first, 0, "a");
  send(second, 0, "b");
  first.step();
  second.step();
  EXPECT_NE(first.hash(), second.hash());
}

TEST(Radio, MeasuresWithThePosesOfTheLastTick) {
  // The arm turns by 1 rad/s: its radio starts within range and leaves it.
  const std::string arm =
      R"(<prototype id="arm" movable="false"><body/><links ref="base">)"
      R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)"
      R"(<link id="tip" geometry="box" size=".1,.1,.1" mass="1"/></links><joints>)"
      R"(<joint id="j" type="revolute" axis="0,0,1"><parent link="base"/>)"
      R"(<child link="tip" position="-1,0,0"/></joint></joints><devices><radios medium="air">)"
      R"(<radio anchor="tip" position="0,0,0" range="0.12"/></radios></devices>)"
      R"(<controller config="mover"/></prototype>)";
  SmallScene small{both, both, testing::robot("a", "1.12,0,0", with_radio()) + arm, ""};
  std::string text = small.str();
  const std::string end = "</controllers>";
  text.insert(
      text.find(end),
      R"(<external_controller id="mover"><actuators><radios implementation="default"/>)"
      R"(<joints implementation="default"><joint id="j" mode="velocity" max_impulse="100"/>)"
      R"(</joints></actuators><sensors/><params/></external_controller>)");
  const auto read = scene::read_text(text, "small.argos");
  ASSERT_TRUE(read.ok()) << scene::to_string(read.problems.front());
  auto moved = read.scene;
  moved.entities[1].devices.radios[0].range = 0.125;
  Simulation simulation(moved, {1});
  simulation.commands().joint_targets[0] = 2;
  const auto gap = [&] {
    const auto& layout = simulation.layout();
    return (world::position_of(simulation.state(), layout.radios[0].mount) -
            world::position_of(simulation.state(), layout.radios[1].mount))
        .norm();
  };
  for (int tick = 0; tick < 5; ++tick) {
    const bool near = gap() < 0.125;
    send(simulation, 1, "t");
    simulation.step();
    EXPECT_EQ(!received(simulation).empty(), near) << tick;
    if (tick == 0) {
      EXPECT_TRUE(near);
      EXPECT_GT(gap(), 0.125);  // it left the range while the message was on its way
    }
  }
}

TEST(Radio, ReachesTheRobotsOtherRadiosAndPublishesLinksIfAsked) {
  const std::string two =
      R"(<radios medium="air"><radio anchor="base" position="0,0,0" range="1"/>)"
      R"(<radio anchor="base" position="0,0,0.05" range="1"/></radios>)";
  for (const char* sensor : {both, showing}) {
    Simulation simulation = SmallScene{both, sensor, testing::robot("a", "0,0,0", two), ""}.run();
    send(simulation, 0, "1");
    send(simulation, 0, "2");
    simulation.step();
    EXPECT_EQ(received(simulation), (Messages{{1, "1"}, {1, "2"}}));
    const auto& rays = simulation.state().rays;
    ASSERT_EQ(rays.size(), sensor == both ? 0u : 1u);
    if (!rays.empty()) {
      EXPECT_EQ(rays[0].kind, world::Ray::Kind::radio);
      EXPECT_NEAR(rays[0].end.z() - rays[0].start.z(), 0.05, 1e-12);
    }
    simulation.step();
    EXPECT_TRUE(simulation.state().rays.empty());
    simulation.list_rays(true);
    send(simulation, 0, "3");
    simulation.step();
    EXPECT_EQ(simulation.rays().size(), 1u);
    EXPECT_EQ(simulation.state().rays.size(), sensor == both ? 0u : 1u);
  }
}

TEST(Radio, AccumulatesNothingWithoutASensor) {
  Simulation simulation = SmallScene{both, "", three_robots().arena, ""}.run();
  for (int tick = 0; tick < 3; ++tick) {
    send(simulation, 0, "a");
    simulation.step();
    EXPECT_TRUE(simulation.commands().radio_messages.entries.empty());
    EXPECT_TRUE(simulation.observations().radio_messages.bytes.empty());
  }
}

TEST(Wifi, ReachesAllFootBotsInRange) {
  const auto foot_bot = [](const std::string& id, const std::string& x,
                           const std::string& range = "10") {
    return "<foot-bot id=\"" + id + "\" wifi_range=\"" + range + R"("><body position=")" + x +
           R"(,0,0"/><controller config="c"/></foot-bot>)";
  };
  constexpr const char* wifi = R"(<wifi implementation="default"/>)";
  Simulation simulation =
      SmallScene{wifi, wifi, foot_bot("a", "0") + foot_bot("b", "1") + foot_bot("c", "3", "2.5")}
          .run();
  EXPECT_EQ(simulation.layout().radios.at(0).id, "wifi");
  send(simulation, 0, "x");
  simulation.step();
  EXPECT_EQ(received(simulation), (Messages{{1, "x"}, {2, "x"}}));
  send(simulation, 2, "y");
  simulation.step();
  EXPECT_EQ(received(simulation), (Messages{{1, "y"}})) << "a is 3 m away";
}

}  // namespace
}  // namespace ziggurat::simulation
