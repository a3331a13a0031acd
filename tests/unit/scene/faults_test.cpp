// Faults of an author, one row each: the part of a scene that is wrong, and what is said of it.
// A part stands on its own line: framework 2, controllers 3, arena 4, engines 5, media 6, rest 7.

#include <gtest/gtest.h>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

enum class Part {
  framework,
  controllers,
  arena,
  entity,
  link,
  loose_link,
  joint,
  device,
  engines,
  media,
  rest
};

struct Row {
  const char* name;
  Part part;
  const char* text;
  const char* expected;  ///< part of the first fault
};

std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

/// A prototype with two links and one joint; `%` marks stand for the part under test.
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
                R"(<radio id="radio"/></media>)";
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

class Fault : public testing::TestWithParam<Row> {};

TEST_P(Fault, IsFoundAtItsPlace) {
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
     "7:1: <loop_functions> is not supported"},
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
     "3:46: <radios> lacks the attribute implementation"},
    {"E34_implementation", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><radios implementation="fast"/></sensors></lua_controller></controllers>)",
     R"(implementation="fast" of <radios> is not one of the words known here; write one of: default)"},
    {"E27_leds_without_medium", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><leds implementation="default"/></actuators></lua_controller></controllers>)",
     "3:48: <leds> lacks the attribute medium"},
    {"E27_leds_wrong_medium", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><leds implementation="default" medium="radio"/></actuators></lua_controller></controllers>)",
     R"(medium="radio" of <leds> names a medium of type radio; a led medium is due)"},
    {"E36_no_impulse", Part::controllers,
     R"(<controllers><lua_controller id="c"><actuators><joints implementation="default"><joint id="j" mode="velocity"/></joints></actuators></lua_controller></controllers>)",
     "<joint> lacks the attribute max_impulse"},
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
    {"E39_two_points", Part::controllers,
     R"(<controllers><lua_controller id="c"><sensors><cameras implementation="default"><camera id="k" range="1:2" anchor="origin" position="0,0,0" orientation="0,0,0" focal_length="1,1" principal_point="1,1" principle_point="1,1" resolution="1,1"/></cameras></sensors></lua_controller></controllers>)",
     "mean the same"},
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
     R"(deadline_ms="9" of <controllers> says nothing beside deadline="wait")"},
};
INSTANTIATE_TEST_SUITE_P(Controllers, Fault, testing::ValuesIn(controller_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row engine_rows[] = {
    {"E7_engine", Part::engines, R"(<physics_engines><dynamics3D id="d"/></physics_engines>)",
     R"(5:18: unknown element <dynamics3D> in <physics_engines>; did you mean "dynamics3d"?)"},
    {"Physx", Part::engines, R"(<physics_engines><physx id="d"/></physics_engines>)",
     "5:18: <physx> is not supported; use <dynamics3d>"},
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
    {"Master_attribute", Part::engines,
     R"(<physics_engines><dynamics3d id="d" default_friction="1"/></physics_engines>)",
     "the attribute default_friction=\"1\" of <dynamics3d> is not supported; write friction"},
    {"Negative_friction", Part::engines,
     R"(<physics_engines><dynamics3d id="d"><floor friction="-1"/></dynamics3d></physics_engines>)",
     R"(friction="-1" of <floor> is negative)"},
    {"E7_medium", Part::media, R"(<media><leds id="l"/></media>)", R"(did you mean "led"?)"},
    {"Simple_radio", Part::media, R"(<media><simple_radio id="l"/></media>)",
     "6:8: <simple_radio> is not supported; use <radio>"},
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

constexpr Row entity_rows[] = {
    {"E11_missing", Part::arena, "<arena/>", "4:1: <arena> lacks the attribute size"},
    {"E11_fields", Part::arena, R"(<arena size="2,2"/>)",
     R"(4:14: size="2,2" of <arena> has 2 components instead of 3; write x,y,z)"},
    {"E7_entity", Part::entity, "<bx/>",
     R"(5:1: unknown element <bx> in <arena>; did you mean "box"?)"},
    {"Eye_bot", Part::entity, "<eye-bot id=\"e\"/>", "5:1: <eye-bot> is not supported"},
    {"E12", Part::entity, R"(<box size="1,1,1" movable="false"><body/></box>)",
     "5:1: <box> lacks the attribute id"},
    {"E13", Part::entity,
     R"(<box id="a" size="1,1,1" movable="false"><body/></box><cylinder id="a" radius="1" height="1" movable="false"><body/></cylinder>)",
     R"(id="a" of <cylinder> is the id of an earlier entity)"},
    {"E14_size", Part::entity, R"(<box id="a" movable="false"><body/></box>)",
     R"(5:1: <box> lacks the attribute size; write size="…" (in box "a"))"},
    {"E14_movable", Part::entity, R"(<box id="a" size="1,1,1" mass="1"><body/></box>)",
     "<box> lacks the attribute movable"},
    {"E14_mass", Part::entity, R"(<box id="a" size="1,1,1" movable="true"><body/></box>)",
     "<box> lacks the attribute mass"},
    {"E14_radius", Part::entity,
     R"(<cylinder id="a" height="1" movable="false"><body/></cylinder>)",
     "<cylinder> lacks the attribute radius"},
    {"E14_height", Part::entity,
     R"(<cylinder id="a" radius="1" movable="false"><body/></cylinder>)",
     "<cylinder> lacks the attribute height"},
    {"Zero_mass", Part::entity, R"(<box id="a" size="1,1,1" movable="true" mass="0"><body/></box>)",
     R"(5:47: mass="0" of <box> is not positive)"},
    {"Negative_mass", Part::entity,
     R"(<box id="a" size="1,1,1" movable="true" mass="-1"><body/></box>)",
     R"(mass="-1" of <box> is negative)"},
    {"Zero_size", Part::entity, R"(<box id="a" size="1,0,1" movable="false"><body/></box>)",
     R"(component 2, "0", is not positive)"},
    {"E16", Part::entity, R"(<box id="a" size="1,1,1" movable="false"/>)",
     "5:1: <box> lacks the element <body>"},
    {"E24_position", Part::entity,
     R"(<box id="a" size="1,1,1" movable="false"><body position="1,2"/></box>)",
     R"(position="1,2" of <body> has 2 components)"},
    {"E17_no_links", Part::entity, R"(<prototype id="p"><body/></prototype>)",
     "<prototype> lacks the element <links>"},
    {"E17_no_ref", Part::entity,
     R"(<prototype id="p"><body/><links><link id="a" geometry="sphere" radius="1" mass="1"/></links></prototype>)",
     "<links> lacks the attribute ref"},
    {"E17_unknown_ref", Part::entity,
     R"(<prototype id="p"><body/><links ref="bace"><link id="base" geometry="sphere" radius="1" mass="1"/></links></prototype>)",
     R"(5:38: ref="bace" of <links> names no link; did you mean "base"?)"},
    {"E32_config", Part::entity,
     R"(<prototype id="p"><body/><controller/><links ref="b"><link id="b" geometry="sphere" radius="1" mass="1"/></links></prototype>)",
     "<controller> lacks the attribute config"},
    {"E32_unknown", Part::entity,
     R"(<prototype id="p"><body/><controller config="c"/><links ref="b"><link id="b" geometry="sphere" radius="1" mass="1"/></links></prototype>)",
     R"(5:46: config="c" of <controller> names no controller)"},
    {"Leds_of_a_box", Part::entity,
     R"(<box id="a" size="1,1,1" movable="false"><body/><leds medium="leds"><led anchor="base" offset="0,0,0" color="red"/></leds></box>)",
     R"(anchor="base" of <led> names no anchor; known here: origin)"},
    {"Light_medium", Part::entity,
     R"(<light id="l" position="0,0,1" color="red" intensity="1" medium="tags"/>)",
     "names a medium of type tag; a led medium is due"},
    {"Arena_floor", Part::entity, R"(<floor id="f" source="loop_functions"/>)",
     R"(source="loop_functions" of <floor> is not supported)"},
};
INSTANTIATE_TEST_SUITE_P(Entities, Fault, testing::ValuesIn(entity_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row link_rows[] = {
    {"E18_geometry", Part::link, R"(<link id="a" mass="1"/>)",
     "<link> lacks the attribute geometry"},
    {"E18_unknown", Part::link, R"(<link id="a" mass="1" geometry="cone"/>)",
     R"(5:33: geometry="cone" of <link> is not one of the words known here; write one of: box, cylinder, sphere)"},
    {"E18_radius", Part::link, R"(<link id="a" mass="1" geometry="sphere"/>)",
     "<link> lacks the attribute radius"},
    {"E18_mass", Part::link, R"(<link id="a" geometry="box" size="1,1,1"/>)",
     "<link> lacks the attribute mass"},
    {"Massless", Part::link, R"(<link id="a" mass="0" geometry="sphere" radius="1"/>)",
     R"(5:1: mass of link "a" is 0)"},
    {"E19_twice", Part::loose_link, R"(<link id="base" mass="1" geometry="sphere" radius="1"/>)",
     R"(5:11: id="base" of <link> is the id of an earlier link)"},
    {"E19_origin", Part::loose_link, R"(<link id="origin" mass="1" geometry="sphere" radius="1"/>)",
     R"(id="origin" of <link> is the name of the entity's own frame)"},
    {"E22_unconnected", Part::loose_link, R"(<link id="a" mass="1" geometry="sphere" radius="1"/>)",
     R"(5:1: link "a" is not connected to the reference link "base")"},
    {"Not_a_link", Part::loose_link, "<lnk/>",
     R"(unknown element <lnk> in <links>; did you mean "link"?)"},
    {"E20_type", Part::joint, R"(<joint id="j"><parent link="base"/><child link="arm"/></joint>)",
     "5:1: <joint> lacks the attribute type"},
    {"E20_planar", Part::joint,
     R"(<joint id="j" type="planar" axis="0,0,1"><parent link="base"/><child link="arm"/></joint>)",
     "fixed, spherical, prismatic, revolute"},
    {"E20_axis", Part::joint,
     R"(<joint id="j" type="revolute"><parent link="base"/><child link="arm"/></joint>)",
     "<joint> lacks the attribute axis"},
    {"Zero_axis", Part::joint,
     R"(<joint id="j" type="revolute" axis="0,0,0"><parent link="base"/><child link="arm"/></joint>)",
     R"(5:37: axis="0,0,0" of <joint> has no direction)"},
    {"E20_parent", Part::joint, R"(<joint id="j" type="fixed"><child link="arm"/></joint>)",
     "<joint> lacks the element <parent>"},
    {"E20_child_link", Part::joint,
     R"(<joint id="j" type="fixed"><parent link="base"/><child/></joint>)",
     "<child> lacks the attribute link"},
    {"E21", Part::joint,
     R"(<joint id="j" type="fixed"><parent link="base"/><child link="amr"/></joint>)",
     R"(5:62: link="amr" of <child> names no link; did you mean "arm"?)"},
    {"E23_second_parent", Part::joint,
     R"(<joint id="j" type="fixed"><parent link="base"/><child link="arm"/></joint>
<joint id="k" type="fixed"><parent link="base"/><child link="arm"/></joint>)",
     R"(6:1: joint "k" gives link "arm" a second parent, after joint "j")"},
    {"Duplicate_joint", Part::link,
     R"(<link id="a" mass="1" geometry="sphere" radius="1"/><link id="b" mass="1" geometry="sphere" radius="1"/></links><joints><joint id="j" type="fixed"><parent link="base"/><child link="b"/></joint>
<joint id="j" type="fixed"><parent link="base"/><child link="a"/></joint></joints></prototype><prototype id="q"><body/><links ref="base"><link id="base" mass="1" geometry="sphere" radius="1"/><link id="a" mass="1" geometry="sphere" radius="1"/>)",
     R"(6:12: id="j" of <joint> is the id of an earlier joint)"},
    {"E25_limit", Part::joint,
     R"(<joint id="j" type="prismatic" axis="0,0,1" limit="1:0"><parent link="base"/><child link="arm"/></joint>)",
     R"(5:52: limit="1:0" of <joint> has its min above its max)"},
    {"E24_limit", Part::joint,
     R"(<joint id="j" type="prismatic" axis="0,0,1" limit="1"><parent link="base"/><child link="arm"/></joint>)",
     "is not a range; write min:max"},
};
INSTANTIATE_TEST_SUITE_P(LinksAndJoints, Fault, testing::ValuesIn(link_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row device_rows[] = {
    {"E26", Part::device, "<led/>",
     R"(5:1: unknown element <led> in <devices>; did you mean "leds"?)"},
    {"Simple_radios", Part::device, "<simple_radios/>",
     "<simple_radios> is not supported; use <radios>"},
    {"E27_missing", Part::device, "<tags/>", "5:1: <tags> lacks the attribute medium"},
    {"E27_unknown", Part::device, R"(<tags medium="tgs"/>)",
     R"(5:15: medium="tgs" of <tags> names no medium; did you mean "tags"?)"},
    {"E27_type", Part::device, R"(<directional_leds medium="leds"/>)",
     R"(names a medium of type led; a directional_led medium is due)"},
    {"E28_led_color", Part::device,
     R"(<leds medium="leds"><led anchor="base" offset="0,0,0"/></leds>)",
     "<led> lacks the attribute color"},
    {"E28_led_anchor", Part::device,
     R"(<leds medium="leds"><led color="red" offset="0,0,0"/></leds>)",
     "<led> lacks the attribute anchor"},
    {"E29_color", Part::device,
     R"(<leds medium="leds"><led anchor="base" color="rad" offset="0,0,0"/></leds>)",
     R"(5:47: color="rad" of <led> is not a colour)"},
    {"E29_channel", Part::device,
     R"(<leds medium="leds"><led anchor="base" color="0,300,0,0" offset="0,0,0"/></leds>)",
     "component 2, \"300\", is out of range"},
    {"E30", Part::device,
     R"(<leds medium="leds"><led anchor="bse" color="red" offset="0,0,0"/></leds>)",
     R"(5:34: anchor="bse" of <led> names no anchor; did you mean "base"?)"},
    {"E28_tag_side", Part::device,
     R"(<tags medium="tags"><tag anchor="base" position="0,0,0" orientation="0,0,0" observable_angle="9"/></tags>)",
     "<tag> lacks the attribute side_length"},
    {"Wide_angle", Part::device,
     R"(<tags medium="tags"><tag anchor="base" position="0,0,0" orientation="0,0,0" observable_angle="190" side_length="1"/></tags>)",
     R"(observable_angle="190" of <tag> is not a half-angle)"},
    {"E28_radio_range", Part::device,
     R"(<radios medium="radio"><radio anchor="base" position="0,0,0"/></radios>)",
     "<radio> lacks the attribute range"},
    {"E28_magnet_field", Part::device,
     R"(<magnets><magnet anchor="base" offset="0,0,0"/></magnets>)",
     "<magnet> lacks the attribute passive_field"},
    {"E13_device", Part::device,
     R"(<magnets><magnet id="m" anchor="base" offset="0,0,0" passive_field="1,0,0"/><magnet id="m" anchor="base" offset="0,0,0" passive_field="1,0,0"/></magnets>)",
     R"(id="m" of <magnet> is the id of an earlier magnet)"},
    {"E31_empty", Part::device, "<proximity_sensors/>", "<proximity_sensors> has no sensor"},
    {"E31_unknown", Part::device, "<proximity_sensors><sonar/></proximity_sensors>",
     "unknown element <sonar> in <proximity_sensors>"},
    {"E28_sensor", Part::device,
     R"(<proximity_sensors><sensor anchor="base" offset="0,0,0" direction="1,0,0"/></proximity_sensors>)",
     "<sensor> lacks the attribute range"},
    {"Ring_without_radius", Part::device,
     R"(<proximity_sensors><ring anchor="base" range="1" num_sensors="3"/></proximity_sensors>)",
     "<ring> lacks the attribute radius"},
    {"Ring_too_many", Part::device,
     R"(<proximity_sensors><ring anchor="base" range="1" radius="1" num_sensors="4000000000"/></proximity_sensors>)",
     "is too many"},
    {"Too_many_sensors", Part::device,
     R"(<proximity_sensors><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><ring anchor="base" range="1" radius="1" num_sensors="1000"/><sensor anchor="base" offset="0,0,0" direction="1,0,0" range="1"/></proximity_sensors>)",
     "a robot has at most 10000 proximity sensors"},
    {"Response_order", Part::device,
     R"(<proximity_sensors response="0.2:1, 0.1:0"><ring anchor="base" range="1" radius="1" num_sensors="3"/></proximity_sensors>)",
     "has distances that do not ascend"},
    {"Response_form", Part::device,
     R"(<proximity_sensors><sensor anchor="base" offset="0,0,0" direction="1,0,0" range="1" response="0.2"/></proximity_sensors>)",
     R"(response="0.2" of <sensor> is not a table; write distance:reading)"},
    {"Bearing_without_medium", Part::device, R"(<range_and_bearing anchor="base"/>)",
     "<range_and_bearing> lacks the attribute medium"},
    {"Overcharged", Part::device, R"(<battery full_charge="1" start_charge="2"/>)",
     "start_charge=\"2\" of <battery> is more than full_charge"},
    {"Discharge_model", Part::device, R"(<battery discharge_model="tim"/>)",
     "write one of: time, motion, time_motion"},
    {"Second_container", Part::device, "<magnets/><magnets/>",
     "5:11: <magnets> is the second of its kind"},
};
INSTANTIATE_TEST_SUITE_P(Devices, Fault, testing::ValuesIn(device_rows),
                         [](const auto& row) { return std::string(row.param.name); });

constexpr Row distribute_rows[] = {
    {"E42_position", Part::entity,
     R"(<distribute><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "5:1: <distribute> lacks the element <position>"},
    {"E42_entity", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/></distribute>)",
     "5:1: <distribute> lacks the element <entity>"},
    {"E42_method", Part::entity,
     R"(<distribute><position method="random"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     R"(method="random" of <position> is not one of the words known here; write one of: uniform, gaussian, constant, grid)"},
    {"E42_quantity", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "<entity> lacks the attribute quantity"},
    {"E42_min_above_max", Part::entity,
     R"(<distribute><position method="uniform" min="0,1,0" max="1,0,1"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     R"(min="0,1,0" of <position> is above max in a component)"},
    {"Missing_max", Part::entity,
     R"(<distribute><position method="uniform" min="0,1,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "<position> lacks the attribute max"},
    {"Negative_deviation", Part::entity,
     R"(<distribute><position method="gaussian" mean="0,1,0" std_dev="0,-1,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "is negative"},
    {"E42_layout", Part::entity,
     R"(<distribute><position method="grid" center="0,0,0" distances="1,1,1" layout="2,0,1"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     R"(layout="2,0,1" of <position> is not a,b,c: component 2, "0", is out of range)"},
    {"E43_cells", Part::entity,
     R"(<distribute><position method="grid" center="0,0,0" distances="1,1,1" layout="2,2,1"/><orientation method="constant" values="0,0,0"/><entity quantity="5" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     R"(quantity="5" of <entity> is more than the 2x2x1 cells of its position grid)"},
    {"E42_nothing", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"/></distribute>)",
     "<entity> has nothing to distribute"},
    {"E42_floor", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><floor id="f"/></entity></distribute>)",
     "unknown element <floor> in <entity>"},
    {"Pattern_without_id", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="1" max_trials="1"><box size="1,1,1" movable="false"/></entity></distribute>)",
     "<box> lacks the attribute id"},
    {"Copy_collides", Part::entity,
     R"(<box id="b12" size="1,1,1" movable="false"><body/></box><distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="5" max_trials="1" base_num="10"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     R"(makes a copy called "b12", which is the id of another entity)"},
    {"Too_many", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="4000000000" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "is too many"},
    {"Number_overflow", Part::entity,
     R"(<distribute><position method="constant" values="0,0,0"/><orientation method="constant" values="0,0,0"/><entity quantity="2" base_num="4294967295" max_trials="1"><box id="b" size="1,1,1" movable="false"/></entity></distribute>)",
     "makes numbers above 4294967295"},
};
INSTANTIATE_TEST_SUITE_P(Distribute, Fault, testing::ValuesIn(distribute_rows),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace ziggurat::scene
