// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::robot;
using testing::SmallScene;

const std::string devices =
    R"(<leds medium="leds"><led anchor="base" offset="0,0,0" color="red"/>)"
    R"(<led anchor="base" offset="0,0,0" color="0,0,255,0"/></leds><directional_leds medium="beams">)"
    R"(<directional_led anchor="base" position="0,0,0" orientation="0,0,0" observable_angle="90" )"
    R"(color="white"/></directional_leds><tags medium="tags"><tag anchor="base" position="0,0,0" )"
    R"(orientation="0,0,0" observable_angle="90" side_length="0.1" payload="p"/></tags><magnets>)"
    R"(<magnet anchor="base" offset="0,0,0" passive_field="1,0,0" active_field="0,2,0"/></magnets>)";
const std::string all =
    R"(<leds implementation="default" medium="leds"/><directional_leds implementation="default"/>)"
    R"(<tags implementation="default"/><magnets implementation="default"/>)";

TEST(Visible, KeepsWhatTheSceneSaysUntilSomethingIsSet) {
  Simulation simulation = SmallScene{all, "", robot("r", "0,0,0", devices), ""}.run();
  for (int tick = 0; tick < 3; ++tick) {
    const world::State& state = simulation.state();
    EXPECT_EQ(state.led_colors, (std::vector<world::Color>{0xFF0000, 0x0000FF}));
    EXPECT_EQ(state.directional_led_colors, (std::vector<world::Color>{0xFFFFFF}));
    EXPECT_EQ(state.tag_payloads, (std::vector<std::string>{"p"}));
    EXPECT_EQ(state.magnet_fields.at(0), math::Vector3(1, 0, 0));
    simulation.step();
  }
}

TEST(Visible, IsInTheStateAfterTheTickInWhichItWasSetAndInTheHash) {
  Simulation simulation = SmallScene{all, "", robot("r", "0,0,0", devices), ""}.run();
  Simulation other = SmallScene{all, "", robot("r", "0,0,0", devices), ""}.run();
  simulation.commands().led_colors[1] = 0x00FF00;
  simulation.commands().tag_payloads[0] = std::string("\0\xFF", 2);
  simulation.commands().magnet_currents[0] = -1.5;
  EXPECT_EQ(simulation.state().led_colors[1], 0x0000FFu);
  EXPECT_EQ(simulation.hash(), other.hash());
  simulation.step();
  other.step();
  EXPECT_EQ(simulation.state().led_colors[1], 0x00FF00u);
  EXPECT_EQ(simulation.state().tag_payloads[0], std::string("\0\xFF", 2));
  EXPECT_EQ(simulation.state().magnet_fields[0], math::Vector3(1, -3, 0));
  EXPECT_NE(simulation.hash(), other.hash());
  simulation.step();
  EXPECT_EQ(simulation.state().led_colors[1], 0x00FF00u);
}

}  // namespace
}  // namespace ziggurat::simulation
