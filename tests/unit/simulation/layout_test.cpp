// SPDX-License-Identifier: MIT
#include "simulation/layout.h"

#include <gtest/gtest.h>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::robot;

const std::string leds = R"(<leds medium="leds"><led anchor="origin" offset="1,2,3" color="red"/>)"
                         R"(<led anchor="base" offset="0,0,0" color="red"/></leds>)";
const std::string radios =
    R"(<radios medium="air"><radio id="x" anchor="base" position="0,0,0" range="2"/></radios>)";

world::Layout layout_of(const std::string& actuators, const std::string& sensors,
                        const std::string& arena) {
  const scene::Scene scene = testing::SmallScene{actuators, sensors, arena, ""}.read();
  return make_layout(scene, scene.entities, 0.01);
}

TEST(Layout, ListsLedsOfAllEntitiesAndThoseThatARobotSets) {
  const std::string box = R"(<box id="b" size="1,1,1" movable="false"><body/><leds medium="leds">)"
                          R"(<led anchor="origin" offset="0,0,0" color="blue"/></leds></box>)";
  const auto layout = layout_of(R"(<leds implementation="default" medium="leds"/>)", "",
                                box + robot("r", "0,0,0", leds) + robot("s", "1,0,0", leds));
  ASSERT_EQ(layout.leds.size(), 5u);
  EXPECT_EQ(layout.leds[0].color, 0x0000FFu);
  EXPECT_EQ(layout.entities[0].leds.count, 1u);
  ASSERT_EQ(layout.robots.size(), 2u);
  EXPECT_EQ(layout.robots[1].leds.begin, 3u);
  EXPECT_EQ(layout.robots[1].leds.count, 2u);
  EXPECT_FALSE(layout.leds[3].mount.link);
  EXPECT_EQ(layout.leds[3].mount.entity, 2u);
  EXPECT_EQ(layout.leds[3].mount.pose.position, math::Vector3(1, 2, 3));
  EXPECT_EQ(layout.leds[4].mount.link, 2u);
}

TEST(Layout, HasNothingToSetWithoutTheActuator) {
  const auto layout = layout_of("", "", robot("r", "0,0,0", leds + radios));
  EXPECT_EQ(layout.leds.size(), 2u);
  EXPECT_EQ(layout.robots[0].leds.count, 0u);
  EXPECT_TRUE(layout.radios.empty());
}

TEST(Layout, SaysWhichRadiosSendAndReceive) {
  const std::string enable = R"(<radios implementation="default"/>)";
  const auto deaf = layout_of(enable, "", robot("r", "0,0,0", radios));
  EXPECT_TRUE(deaf.radios.at(0).sends);
  EXPECT_FALSE(deaf.radios.at(0).receives);
  const auto mute = layout_of("", enable, robot("r", "0,0,0", radios));
  EXPECT_FALSE(mute.radios.at(0).sends);
  EXPECT_TRUE(mute.radios.at(0).receives);
  EXPECT_EQ(mute.radios.at(0).range, 2);
}

TEST(Layout, TheForceOfAMotorIsAnImpulsePerSubstepOfTheClock) {
  scene::Scene scene =
      testing::SmallScene{
          R"(<joints implementation="default"><joint id="j" mode="velocity" max_torque="3"/></joints>)",
          "",
          R"(<prototype id="p"><body/><controller config="c"/><links ref="a">)"
          R"(<link id="a" geometry="box" size=".1,.1,.1" mass="1"/>)"
          R"(<link id="b" geometry="box" size=".1,.1,.1" mass="1"/></links><joints>)"
          R"(<joint id="j" type="revolute" axis="0,0,1"><parent link="a" position="0,0,.2"/>)"
          R"(<child link="b"/></joint></joints></prototype>)"}
          .read();
  const auto impulse = [&](scene::Clock clock) {
    scene.physics.clock = clock;
    return Simulation(scene, {1}).layout().joint_actuators.at(0).max_impulse;
  };
  EXPECT_DOUBLE_EQ(impulse(scene::Clock::nominal), 3 * 0.05);  // 10 ticks/s, 2 substeps
  EXPECT_DOUBLE_EQ(impulse(scene::Clock::beta50), 3 * 0.025);
}

}  // namespace
}  // namespace ziggurat::simulation
