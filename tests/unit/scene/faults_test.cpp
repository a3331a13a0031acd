// SPDX-License-Identifier: MIT
// Faults of a scene's sections; faults of entities are in entity_faults_test.cpp.

#include "faults.h"

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

/// A prototype with a base; `links`, `joints` and `devices` are added to it.
std::string prototype(const std::string& links, const std::string& joints,
                      const std::string& devices) {
  return R"(<prototype id="p"><body/><links ref="base">)"
         R"(<link id="base" geometry="sphere" radius="1" mass="1"/>)" +
         links + "</links><joints>" + joints + "</joints><devices>" + devices +
         "</devices></prototype>";
}

constexpr const char* arm = R"(<link id="arm" geometry="sphere" radius="1" mass="1"/>)";
constexpr const char* joint_to_a =
    R"(<joint id="j" type="fixed"><parent link="base"/><child link="a"/></joint>)";
constexpr const char* arm_joint =
    R"(<joint id="j" type="fixed"><parent link="base"/><child link="arm"/></joint>)";

SceneText with(Part part, const std::string& text) {
  SceneText scene;
  scene.media = R"(<media><led id="leds"/><directional_led id="dirs"/><tag id="tags"/>)"
                R"(<radio id="radio"/><radio id="radio2"/></media>)";
  switch (part) {
    case Part::framework:
      scene.framework = text;
      break;
    case Part::controllers:
      scene.controllers = text;
      break;
    case Part::arena:
      scene.arena = text;
      break;
    case Part::entity:
      scene.arena = "<arena size=\"2,2,2\">\n" + text + "</arena>";
      break;
    case Part::loose_link:
      scene.arena = "<arena size=\"2,2,2\">" + prototype("\n" + text, "", "") + "</arena>";
      break;
    case Part::link:
      scene.arena = "<arena size=\"2,2,2\">" + prototype("\n" + text, joint_to_a, "") + "</arena>";
      break;
    case Part::joint:
      scene.arena = "<arena size=\"2,2,2\">" + prototype(arm, "\n" + text, "") + "</arena>";
      break;
    case Part::device:
      scene.arena = "<arena size=\"2,2,2\">" + prototype(arm, arm_joint, "\n" + text) + "</arena>";
      break;
    case Part::engines:
      scene.engines = text;
      break;
    case Part::media:
      scene.media = text;
      break;
    case Part::rest:
      scene.rest = text;
      break;
  }
  return scene;
}

TEST_P(Fault, IsReportedAtItsPlace) {
  const Row& row = GetParam();
  const ReadResult result = with(row.part, row.text).read();
  const auto texts = faults(result);
  ASSERT_FALSE(texts.empty()) << all_problems(result);
  EXPECT_EQ(texts.size(), 1u) << all_problems(result);
  EXPECT_NE(texts[0].find(row.expected), std::string::npos) << "expected: " << row.expected << "\n"
                                                            << all_problems(result);
}

constexpr Row framework_rows[] = {
    {"E2_framework", Part::framework, "",
     "1:1: <argos-configuration> lacks the element <framework>"},
    {"E2_controllers", Part::controllers, "",
     "1:1: <argos-configuration> lacks the element <controllers>"},
    {"E2_arena", Part::arena, "", "1:1: <argos-configuration> lacks the element <arena>"},
    {"E2_engines", Part::engines, "",
     "1:1: <argos-configuration> lacks the element <physics_engines>"},
    {"E2_media", Part::media, "", "1:1: <argos-configuration> lacks the element <media>"},
    {"E3_experiment", Part::framework, "<framework/>",
     "2:1: <framework> lacks the element <experiment>"},
    {"E3_no_rate", Part::framework, "<framework><experiment/></framework>",
     "2:12: <experiment> lacks the attribute ticks_per_second"},
    {"E3_fraction", Part::framework,
     R"(<framework><experiment ticks_per_second="2.5"/></framework>)",
     R"(2:42: ticks_per_second="2.5" of <experiment> has a fraction)"},
    {"E3_zero", Part::framework, R"(<framework><experiment ticks_per_second="0"/></framework>)",
     "2:42: ticks_per_second=\"0\""},
    {"Negative_length", Part::framework,
     R"(<framework><experiment ticks_per_second="10" length="-1"/></framework>)", "is negative"},
    {"Endless_length", Part::framework,
     R"(<framework><experiment ticks_per_second="10" length="1e200"/></framework>)", "is too long"},
    {"Negative_seed", Part::framework,
     R"(<framework><experiment ticks_per_second="10" random_seed="-1"/></framework>)",
     "random_seed=\"-1\""},
    {"E4_method", Part::framework,
     R"(<framework><system threads="2" method="fast"/><experiment ticks_per_second="1"/></framework>)",
     R"(method="fast" of <system> is not one of the words known here; write one of: balance_quantity)"},
    {"E4_format", Part::framework,
     R"(<framework><experiment ticks_per_second="1"/><profiling file="p" format="x"/></framework>)",
     "human_readable, table"},
    {"E15_boolean", Part::framework,
     R"(<framework><experiment ticks_per_second="1" real_time="True"/></framework>)",
     R"(2:56: real_time="True" of <experiment> is not a truth value; write true or false)"},
    {"Misspelt_attribute", Part::framework,
     R"(<framework><experiment ticks_per_second="1" lenght="5"/></framework>)",
     R"(2:45: <experiment> has an unknown attribute lenght="5"; did you mean "length"?)"},
    {"Misspelt_element", Part::framework,
     R"(<framework><experiment ticks_per_second="1"/><sytem/></framework>)",
     R"(2:46: unknown element <sytem> in <framework>; did you mean "system"?)"},
    {"Loop_functions", Part::rest, "<loop_functions label=\"x\"/>\n",
     "7:1: <loop_functions> has no script, and libraries are not loaded into the server"},
    {"Loop_functions_library", Part::rest, "<loop_functions library=\"x\" script=\"y.lua\"/>\n",
     "7:1: <loop_functions> has no script, and libraries are not loaded into the server"},
    {"Director_without_id_twice", Part::rest,
     "<director script=\"a.lua\"/><director script=\"b.lua\"/>\n",
     "7:27: <director> lacks the attribute id"},
    {"Director_starts_twice", Part::rest, "<director id=\"a\" script=\"a.lua\" command=\"./b\"/>\n",
     "7:1: <director> has a script and a command; write one of them"},
    {"Director_twice", Part::rest, "<director id=\"a\"/><director id=\"a\"/>\n", "director"},
    {"Director_one_too_many", Part::rest,
     "<director id=\"a\"/><director id=\"b\"/><director id=\"c\"/><director id=\"d\"/>"
     "<director id=\"e\"/>\n",
     "<director> is one too many; a scene has 4 directors at most"},
    {"Unknown_section", Part::rest, "<physic_engines/>\n",
     "7:1: unknown element <physic_engines> in <argos-configuration>; did you mean "
     "\"physics_engines\"?"},
};
INSTANTIATE_TEST_SUITE_P(Framework, Fault, testing::ValuesIn(framework_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row controller_rows[] = {
    {"E5_no_id", Part::controllers,
     "<controllers><lua_controller><actuators/><sensors/></lua_controller></controllers>",
     "3:14: <lua_controller> lacks the attribute id"},
    {"E6_twice", Part::controllers,
     R"(<controllers><lua_controller id="c"/><lua_controller id="c"/></controllers>)",
     R"(3:58: id="c" of <lua_controller> is the id of an earlier controller)"},
    {"E34_unknown_sensor", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><joint implementation="default"/></sensors></lua_controller></controllers>)",
     R"(3:46: unknown element <joint> in <sensors>; did you mean "joints"?)"},
    {"E34_no_implementation", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><radios/></sensors></lua_controller></controllers>)",
     R"(3:46: <radios> lacks the attribute implementation; write implementation="default")"},
    {"E34_implementation", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><radios implementation="fast"/></sensors></lua_controller></controllers>)",
     R"(implementation="fast" of <radios> is not one of the words known here; write one of: default)"},
    {"E27_leds_without_medium", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><leds implementation="default"/></actuators></lua_controller></controllers>)",
     "3:48: <leds> lacks the attribute medium"},
    {"E27_leds_wrong_medium", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><leds implementation="default" medium="radio"/></actuators></lua_controller></controllers>)",
     R"(medium="radio" of <leds> names a medium of type radio; name a led medium)"},
    {"E36_no_impulse", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><joints implementation="default"><joint id="j" mode="velocity"/></joints></actuators></lua_controller></controllers>)",
     "<joint> lacks the attribute max_force or max_torque or max_impulse; write one"},
    {"E36_misspelt_force", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><joints implementation="default"><joint id="j" mode="velocity" max_forse="1"/></joints></actuators></lua_controller></controllers>)",
     R"(unknown attribute max_forse="1"; did you mean "max_force"? (--lenient ignores it))"},
    {"E36_two_strengths", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><joints implementation="default"><joint id="j" mode="velocity" max_force="1" max_impulse="1"/></joints></actuators></lua_controller></controllers>)",
     "<joint> has more than one of max_force, max_torque and max_impulse; write one"},
    {"Misspelt_device_of_kilobots", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><kilobot_ligth implementation="default"/></sensors></lua_controller></controllers>)",
     R"(unknown element <kilobot_ligth> in <sensors>; did you mean "kilobot_light"?)"},
    {"Actuator_among_sensors", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><quadrotor_speed implementation="default"/></sensors></lua_controller></controllers>)",
     "<quadrotor_speed> can't stand in <sensors>; write it into <actuators>"},
    {"Device_of_thymios", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><thymio_light implementation="rot_z_only"/></sensors></lua_controller></controllers>)",
     "<thymio_light> is a device of the thymio, which is not modelled here; remove it, or "
     "write <light>"},
    {"Device_of_drones", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><drone_flight_system implementation="default"/></actuators></lua_controller></controllers>)",
     "<drone_flight_system> is a device of the drone, which is not modelled here; remove it"},
    {"E36_mode", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><joints implementation="default"><joint id="j" mode="speed"/></joints></sensors></lua_controller></controllers>)",
     R"(mode="speed" of <joint> is not one of the words known here; write one of: position, velocity, disabled)"},
    {"E38_noise", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><proximity implementation="default" noise_level="-0.1"/></sensors></lua_controller></controllers>)",
     R"(noise_level="-0.1" of <proximity> is negative)"},
    {"E39_camera_range", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><cameras implementation="default"><camera id="k" anchor="origin" position="0,0,0" orientation="0,0,0" focal_length="1,1" principal_point="1,1" resolution="1,1"/></cameras></sensors></lua_controller></controllers>)",
     "<camera> lacks the attribute range"},
    {"E25_camera_range", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><cameras implementation="default"><camera id="k" range="2:1" anchor="origin" position="0,0,0" orientation="0,0,0" focal_length="1,1" principal_point="1,1" resolution="1,1"/></cameras></sensors></lua_controller></controllers>)",
     "has its min above its max"},
    {"E7_algorithm", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><cameras implementation="default"><camera id="k" range="1:2" anchor="origin" position="0,0,0" orientation="0,0,0" focal_length="1,1" principal_point="1,1" resolution="1,1"><tags_detector medium="tags"/></camera></cameras></sensors></lua_controller></controllers>)",
     R"(unknown element <tags_detector> in <camera>; did you mean "tag_detector"?)"},
    {"Command_on_lua", Part::controllers,
     R"(<controllers><lua_controller id="c" command="x"/></controllers>)",
     "unknown attribute command"},
    {"Deadline_action", Part::controllers,
     R"(<controllers><lua_controller id="c" deadline="hodl" deadline_ms="5"/></controllers>)",
     R"(3:47: deadline="hodl" of <lua_controller> is no deadline action; did you mean "hold"?)"},
    {"Deadline_unlike_any", Part::controllers, R"(<controllers deadline="" deadline_ms="5"/>)",
     "is no deadline action; known here: wait, hold, zero, drop, stop"},
    {"Deadline_without_time", Part::controllers,
     R"(<controllers deadline="zero"><lua_controller id="c"/></controllers>)",
     R"(3:24: deadline="zero" of <controllers> needs a time; write deadline_ms="50" beside it)"},
    {"Deadline_of_0", Part::controllers,
     R"(<controllers><x_controller id="c" deadline="drop" deadline_ms="0"/></controllers>)",
     R"(deadline_ms="0" of <x_controller> is out of range; write a whole number from 1 to)"},
    {"Deadline_with_fraction", Part::controllers,
     R"(<controllers><x_controller id="c" deadline="drop" deadline_ms="0.5"/></controllers>)",
     R"(deadline_ms="0.5" of <x_controller> has a fraction; write a whole number from 1 to)"},
    {"Deadline_budget", Part::controllers,
     R"(<controllers deadline="stop" deadline_ms="9" miss_budget="-1"/>)",
     R"(miss_budget="-1" of <controllers> is out of range; write a whole number from 0 to)"},
    {"Deadline_budget_alone", Part::controllers,
     R"(<controllers deadline="hold" deadline_ms="9"><lua_controller id="c" miss_budget="3"/></controllers>)",
     R"(miss_budget="3" of <lua_controller> needs a deadline; write deadline="hold" beside it)"},
    {"Deadline_time_alone", Part::controllers, R"(<controllers deadline_ms="9"/>)",
     R"(deadline_ms="9" of <controllers> needs a deadline)"},
    {"Deadline_wait_with_time", Part::controllers,
     R"(<controllers deadline="wait" deadline_ms="9"/>)",
     R"(deadline_ms="9" of <controllers> has no effect beside deadline="wait")"},
};
INSTANTIATE_TEST_SUITE_P(Controllers, Fault, testing::ValuesIn(controller_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row engine_rows[] = {
    {"E7_engine", Part::engines, R"(<physics_engines><dynamics3D id="d"/></physics_engines>)",
     R"(5:18: unknown element <dynamics3D> in <physics_engines>; did you mean "dynamics3d"?)"},
    {"Physx", Part::engines, R"(<physics_engines><physx id="d"/></physics_engines>)",
     "5:18: <physx> is not supported; use <dynamics3d> (--lenient reads it as one)"},
    {"E7_plug_in", Part::engines,
     R"(<physics_engines><dynamics3d id="d"><gravty g="1"/></dynamics3d></physics_engines>)",
     R"(unknown element <gravty> in <dynamics3d>; did you mean "gravity"?)"},
    {"E8", Part::engines, "<physics_engines><dynamics3d/></physics_engines>",
     "5:18: <dynamics3d> lacks the attribute id"},
    {"E9", Part::engines,
     R"(<physics_engines><dynamics2d id="d"/><dynamics3d id="d"/></physics_engines>)",
     "is the id of an earlier engine"},
    {"Two_worlds", Part::engines,
     R"(<physics_engines><dynamics3d id="a"/><dynamics3d id="b"/></physics_engines>)",
     "5:38: <dynamics3d> is the second of its kind"},
    {"E46", Part::engines,
     R"(<physics_engines><dynamics3d id="d" iterations="0"/></physics_engines>)",
     R"(5:49: iterations="0" of <dynamics3d> is out of range)"},
    {"Clock", Part::engines,
     R"(<physics_engines><dynamics3d id="d" clock="slow"/></physics_engines>)", "nominal, beta50"},
    {"Substep", Part::engines,
     R"(<physics_engines><dynamics3d id="d" max_substep="1e-300"/></physics_engines>)",
     "is too short"},
    {"Negative_friction", Part::engines,
     R"(<physics_engines><dynamics3d id="d"><floor friction="-1"/></dynamics3d></physics_engines>)",
     R"(friction="-1" of <floor> is negative)"},
    {"E7_medium", Part::media, R"(<media><leds id="l"/></media>)", R"(did you mean "led"?)"},
    {"E8_medium", Part::media, "<media><led/></media>", "6:8: <led> lacks the attribute id"},
    {"E9_medium", Part::media, R"(<media><led id="a"/><tag id="a"/></media>)",
     R"(6:30: id="a" of <tag> is the id of an earlier medium)"},
    {"E10", Part::media, R"(<media><led id="a" index="octree"/></media>)",
     R"(index="octree" of <led> is not one of the words known here; write one of: grid)"},
    {"Grid_size", Part::media, R"(<media><led id="a" grid_size="1,2"/></media>)",
     "has 2 components"},
};
INSTANTIATE_TEST_SUITE_P(EnginesAndMedia, Fault, testing::ValuesIn(engine_rows),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace ziggurat::scene
