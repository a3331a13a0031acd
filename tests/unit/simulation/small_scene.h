// SPDX-License-Identifier: MIT
#pragma once
// Scenes of a few robots without gravity, written as text.

#include <gtest/gtest.h>

#include <string>

#include "scene/reader.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation::testing {

enum class Base { free, fixed };

constexpr double g = 9.8;  // [m/s^2]
inline const std::string gravity = R"(<gravity g="10"/>)";
inline const std::string wheels = R"(<differential_steering implementation="default"/>)";
constexpr const char* ground = R"(<floor/><gravity g="9.8"/>)";

struct SmallScene {
  std::string actuators, sensors;  ///< of the controller `c`
  std::string arena;               ///< entities
  std::string engine = {};         ///< in <dynamics3d>

  std::string str() const {
    return R"(<argos><framework><experiment ticks_per_second="10"/></framework><controllers>)"
           R"(<external_controller id="c"><actuators>)" +
           actuators + "</actuators><sensors>" + sensors +
           R"(</sensors><params/></external_controller></controllers><arena size="9,9,9">)" +
           arena + R"(</arena><physics_engines><dynamics3d id="d" iterations="2">)" + engine +
           R"(</dynamics3d></physics_engines><media><radio id="air"/><led id="leds"/>)"
           R"(<directional_led id="beams"/><tag id="tags"/><range_and_bearing id="rab"/>)"
           R"(<range_and_bearing id="through" check_occlusions="false"/></media></argos>)";
  }

  scene::ReadResult read_all() const {
    scene::ReadResult result = scene::read_text(str(), "small.argos");
    for (const auto& problem : result.problems) {
      EXPECT_EQ(problem.severity, scene::Problem::Severity::notice) << scene::to_string(problem);
    }
    return result;
  }
  scene::Scene read() const { return read_all().scene; }

  Simulation run(std::uint64_t seed = 1) const { return Simulation(read(), {seed}); }
};

/// A robot of one box of 10 cm with `devices` at `position`, driven by `c`.
inline std::string robot(const std::string& id, const std::string& position,
                         const std::string& devices, const std::string& orientation = "0,0,0") {
  return "<prototype id=\"" + id + "\"><body position=\"" + position + "\" orientation=\"" +
         orientation + R"("/><links ref="base"><link id="base" geometry="box" size=".1,.1,.1" )" +
         R"(mass="1"/></links><devices>)" + devices +
         R"(</devices><controller config="c"/></prototype>)";
}

/// A robot of one link of 0.1 m and 1 kg, without drag, driven by `c`.
/// @param body  attributes of <body>
inline std::string smooth_robot(const std::string& body, const std::string& friction = "0.5") {
  return R"(<prototype id="r"><body )" + body +
         R"(/><links ref="base"><link id="base" geometry="box" size=".1,.1,.1" mass="1" friction=")" +
         friction + R"(" linear_damping="0" angular_damping="0"/></links>)" +
         R"(<controller config="c"/></prototype>)";
}

inline void run(Simulation& simulation, int ticks) {
  for (int i = 0; i < ticks; ++i) simulation.step();
}

}  // namespace ziggurat::simulation::testing
