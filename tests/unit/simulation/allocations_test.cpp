// SPDX-License-Identifier: MIT
// A steady tick of the simulation allocates nothing, whatever devices sense and do.

#include "allocations/allocations.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::robot;
using testing::SmallScene;

constexpr const char* actuators =
    R"(<radios implementation="default"/><leds implementation="default" medium="leds"/>
       <directional_leds implementation="default"/><tags implementation="default"/>
       <magnets implementation="default"/><range_and_bearing implementation="default"/>)";
constexpr const char* sensors =
    R"(<radios implementation="default"/><positioning implementation="default"
         pos_noise_range="0:0.1" angle_noise_range="0:1"/>
       <battery implementation="default"/>
       <proximity implementation="default" noise_level="0.1" show_rays="true"/>
       <range_and_bearing implementation="medium" medium="rab" noise_std_dev="0.1"/>
       <imus implementation="default"><imu id="imu" anchor="base" acceleration_noise="0.1"
         angular_velocity_bias_walk="0.1"/></imus>
       <cameras implementation="default" show_frustum="true"><camera id="eye" anchor="base"
         position="0,0,0.06" orientation="-90,90,0" range="0.05:2" resolution="640,480"
         focal_length="300,300" principal_point="320,240" image="true"><led_detector medium="leds"
         show_rays="true"/><directional_led_detector medium="beams"/><tag_detector medium="tags"/>
       </camera></cameras>)";
constexpr const char* devices =
    R"(<radios medium="air"><radio id="radio" anchor="base" position="0,0,0.1" range="3"/></radios>
       <leds medium="leds"><led id="led" anchor="base" offset="0,0,0.06" color="red"/></leds>
       <directional_leds medium="beams"><directional_led id="beam" anchor="base"
         position="0,0,0.06" orientation="0,0,0" observable_angle="80" color="green"/>
       </directional_leds>
       <tags medium="tags"><tag id="tag" anchor="base" position="-0.051,0,0"
         orientation="0,-90,0" observable_angle="80" side_length="0.04"
         payload="longer than a string that is stored in place"/></tags>
       <magnets><magnet id="coil" anchor="base" offset="0,0,0" passive_field="0,0,0"
         active_field="0,0,1"/></magnets>
       <proximity_sensors><sensor anchor="base" offset="0.05,0,0" direction="1,0,0" range="1"/>
       </proximity_sensors>
       <range_and_bearing medium="rab" anchor="base" position="0,0,0.1"/>
       <battery discharge_model="time_motion" factor="0.001"/>)";

/// Allocations of ticks after a few that let buffers grow.
std::size_t allocations_of_steady_ticks(const SmallScene& scene) {
  Simulation world = scene.run();
  const std::vector<std::uint8_t> message(100, 7);
  std::size_t before = 0;
  for (int tick = 0; tick < 40; ++tick) {
    world::Commands& commands = world.commands();
    for (std::size_t i = 0; i < commands.led_colors.size(); ++i) {
      commands.led_colors[i] = static_cast<world::Color>(tick + 1);
    }
    for (std::size_t i = 0; i < world.layout().radios.size(); i += 2) {
      commands.radio_messages.add(i, message);
    }
    for (std::size_t i = 0; i < commands.device_commands.size(); ++i) {
      const bool switches = world.layout().device_commands[i]->name == std::string("enabled");
      if (switches) commands.device_commands[i] = 1;
    }
    if (tick == 20) before = ziggurat::testing::allocations();
    world.step();
  }
  EXPECT_GT(before, 0U) << "they are not counted";
  return ziggurat::testing::allocations() - before;
}

TEST(Tick, OfRobotsWithAllDevicesAllocatesNothing) {
  std::string arena;
  for (int i = 0; i < 4; ++i) {
    arena += robot("r" + std::to_string(i), std::to_string(0.3 * i) + ",0,1", devices);
  }
  EXPECT_EQ(allocations_of_steady_ticks({actuators, sensors, arena, ""}), 0U);
}

TEST(Tick, OfRobotsOnWheelsAllocatesNothing) {
  EXPECT_EQ(
      allocations_of_steady_ticks(
          {R"(<differential_steering implementation="default"/><footbot_turret implementation="default"/>)",
           R"(<differential_steering implementation="default"/>
              <footbot_turret_encoder implementation="default"/>
              <footbot_proximity implementation="default"/>)",
           R"(<foot-bot id="a"><body position="0,0,0"/><controller config="c"/></foot-bot>
              <foot-bot id="b"><body position="1,0,0"/><controller config="c"/></foot-bot>)",
           R"(<floor/><gravity g="9.8"/>)"}),
      0U);
}

TEST(Tick, OfRobotsThatFlyAllocatesNothing) {
  EXPECT_EQ(allocations_of_steady_ticks(
                {R"(<quadrotor_position implementation="default"/>)",
                 R"(<eyebot_proximity implementation="default"/>)",
                 R"(<eye-bot id="a"><body position="0,0,1"/><controller config="c"/></eye-bot>
              <eye-bot id="b"><body position="1,0,1"/><controller config="c"/></eye-bot>)",
                 R"(<floor/><gravity g="9.8"/>)"}),
            0U);
}

TEST(Tick, OfKilobotsThatSendAllocatesNothing) {
  std::string arena;
  for (const char* place : {"0,0,0", "0.05,0,0", "0,0.05,0", "0.05,0.05,0"}) {
    arena += std::string("<kilobot id=\"k") + std::to_string(arena.size()) +
             "\"><body position=\"" + place + "\"/><controller config=\"c\"/></kilobot>";
  }
  EXPECT_EQ(allocations_of_steady_ticks(
                {R"(<kilobot_communication implementation="default"/>
              <kilobot_differential_drive implementation="default"/>)",
                 R"(<kilobot_communication implementation="default" noise_std_dev="0.002"/>)",
                 arena, R"(<floor/><gravity g="9.8"/>)"}),
            0U);
}

TEST(Tick, OfBuilderbotsAllocatesNothing) {
  EXPECT_EQ(
      allocations_of_steady_ticks(
          {R"(<builderbot_differential_drive implementation="default"/>
              <builderbot_lift_system implementation="default"/>)",
           R"(<builderbot_rangefinders implementation="default"/>
              <builderbot_lift_system implementation="default"/>)",
           R"(<builderbot id="a"><body position="0,0,0"/><controller config="c"/></builderbot>)",
           R"(<floor/><gravity g="9.8"/>)"}),
      0U);
}

}  // namespace
}  // namespace ziggurat::simulation
