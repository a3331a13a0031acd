// SPDX-License-Identifier: MIT
// Slips of the pen: each gives one message, where it was made, and not those that follow from it.

#include <gtest/gtest.h>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

constexpr const char* slider = R"(<argos-configuration>
  <framework><experiment ticks_per_second="10"/></framework>
  <controllers>
    <lua_controller id="push">
      <actuators>
        <joints implementation="default"><joint id="rail" mode="velocity" max_impulse="1"/></joints>
        <radios implementation="default"/>
      </actuators>
      <sensors/>
      <params script="slider.lua"/>
    </lua_controller>
  </controllers>
  <arena size="2,2,1">
    <prototype id="slider" movable="false">
      <body position="0,0,0"/>
      <controller config="push"/>
      <links ref="base">
        <link id="base" geometry="box" size="0.4,0.1,0.1" mass="1"/>
        <link id="sled" geometry="box" size="0.1,0.1,0.05" mass="0.2"/>
      </links>
      <joints>
        <joint id="rail" type="prismatic" axis="1,0,0">
          <parent link="base"/>
          <child link="sled"/>
        </joint>
      </joints>
      <devices>
        <radios medium="air"><radio id="r" anchor="sled" position="0,0,0" range="1"/></radios>
      </devices>
    </prototype>
  </arena>
  <physics_engines><dynamics3d id="d"/></physics_engines>
  <media><radio id="air"/></media>
</argos-configuration>
)";

/// A part of the scene, what is written instead, and the only fault.
struct Slip {
  const char* right;
  const char* wrong;
  const char* fault;
};

std::ostream& operator<<(std::ostream& out, const Slip& slip) { return out << slip.wrong; }

class Slips : public testing::TestWithParam<Slip> {};

TEST_P(Slips, AreToldWhereTheyWereMade) {
  std::string text = slider;
  const std::string right = GetParam().right, wrong = GetParam().wrong;
  ASSERT_NE(text.find(right), std::string::npos);
  text.replace(text.find(right), right.size(), wrong);
  const bool is_element = right.starts_with('<') && right.find(' ') == std::string::npos;
  const std::string end = "</" + right.substr(1);
  if (is_element && text.find(end) != std::string::npos) {
    text.replace(text.rfind(end), end.size(), "</" + wrong.substr(1));
  }
  const auto found = faults(read_text(text, "t"));
  ASSERT_EQ(found.size(), 1u) << testing::PrintToString(found);
  EXPECT_EQ(found[0].substr(0, std::string(GetParam().fault).size()), GetParam().fault);
  EXPECT_EQ(found[0].find("remove it"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Elements, Slips,
    testing::Values(
        Slip{"<framework>", "<framwork>", "t:2:3: unknown element <framwork>"},
        Slip{"<controllers>", "<controlers>", "t:3:3: unknown element <controlers>"},
        Slip{"<actuators>", "<actuator>", "t:5:7: unknown element <actuator>"},
        Slip{"<sensors/>", "<senors/>", "t:9:7: unknown element <senors>"},
        Slip{"<params ", "<parms ", "t:10:7: unknown element <parms>"},
        Slip{"<body ", "<bdy ", "t:15:7: unknown element <bdy>"},
        Slip{"<link id=\"sled\"", "<lnk id=\"sled\"", "t:19:9: unknown element <lnk>"},
        Slip{"      <joints>\n", "      <jonts>\n",
             "t:26:7: malformed XML: </joints> does not close <jonts> of line 21; write </jonts>, "
             "or <joints> there"},
        Slip{"<parent ", "<parrent ", "t:23:11: unknown element <parrent>"},
        Slip{"<devices>", "<device>", "t:27:7: unknown element <device>"},
        Slip{"<physics_engines>", "<physic_engines>", "t:32:3: unknown element <physic_engines>"},
        Slip{"<dynamics3d ", "<dynamic3d ", "t:32:20: unknown element <dynamic3d>"},
        Slip{"<media>", "<medai>", "t:33:3: unknown element <medai>"},
        Slip{"<dynamics3d id=\"d\"/>", "<gravity g=\"9.8\"/>",
             "t:32:20: <gravity> can't stand in <physics_engines>; write it into <dynamics3d>"}));

TEST(Slip, AMisspeltListOfJointsHidesWhatFollows) {
  std::string text = slider;
  text.replace(text.find("      <joints>\n"), 15, "      <jonts>\n");
  text.replace(text.rfind("</joints>"), 9, "</jonts>");
  const auto found = faults(read_text(text, "t"));
  ASSERT_EQ(found.size(), 1u) << testing::PrintToString(found);
  EXPECT_EQ(
      found[0],
      "t:21:7: unknown element <jonts> in <prototype>; did you mean \"joints\"? (in prototype "
      "\"slider\")");
}

INSTANTIATE_TEST_SUITE_P(
    Attributes, Slips,
    testing::Values(
        Slip{"mass=\"0.2\"", "mas=\"0.2\"", "t:19:60: <link> has an unknown attribute mas=\"0.2\""},
        Slip{"mass=\"0.2\"", "mass=\"-0.2\"",
             "t:19:66: mass=\"-0.2\" of <link> is negative; write more than 0 kg"},
        Slip{"max_impulse=\"1\"", "max_force=\"5N\"",
             "t:6:86: max_force=\"5N\" of <joint> has \"N\" behind the number"},
        Slip{"config=\"push\"", "config=\"pusch\"", "t:16:27: config=\"pusch\" of <controller>"},
        Slip{"parent link=\"base\"", "parent link=\"bse\"",
             "t:23:25: link=\"bse\" of <parent> names no link; did you mean \"base\"?"},
        Slip{"<link id=\"sled\"", "<link id=\"base\"",
             "t:19:19: id=\"base\" of <link> is the id of an earlier link at line 18;"},
        Slip{"type=\"prismatic\"", "type=\"slider\"", "t:22:32: type=\"slider\" of <joint>"},
        Slip{"<radio id=\"air\"", "<radio id=\"air\"/><led id=\"air\"",
             "t:33:36: id=\"air\" of <led> is the id of an earlier medium at line 33;"}));

INSTANTIATE_TEST_SUITE_P(
    Text, Slips,
    testing::Values(
        Slip{"mass=\"0.2\"", "mass=\"0.2",
             "t:19:65: malformed XML: the value of mass in <link> has no closing quote"},
        Slip{"geometry=\"box\" size=\"0.1,0.1,0.05\"", "geometry=\"box size=\"0.1,0.1,0.05\"",
             "t:19:34: malformed XML: the value of geometry in <link> has no closing quote"},
        Slip{"id=\"push\">", "id=\"push>",
             "t:4:24: malformed XML: the value of id in <lua_controller> has no closing quote"},
        Slip{"link=\"base\"", "link=base",
             "t:23:24: malformed XML: the value of link in <parent> has no quotes; write "
             "link=\"base\""},
        Slip{"link=\"base\"", "link=”base”",
             "t:23:24: malformed XML: the value of link in <parent> has curly quotes, which are "
             "none in XML; write "
             "link=\"base\""},
        Slip{"link=\"base\"", "link=base\"",
             "t:23:24: malformed XML: the value of link in <parent>"},
        Slip{"link=\"base\"", "link",
             "t:23:19: malformed XML: the attribute link of <parent> has no"},
        Slip{"mass=\"0.2\"/>", "mass=\"0.2\"\"/>",
             "t:19:70: malformed XML: \"\"\" stands directly behind the value of mass"},
        Slip{"    </prototype>\n", "",
             "t:14:5: malformed XML: <prototype> is not closed before </arena> at line 30"},
        Slip{"<child link=\"sled\"/>", "<child link=\"sled\">",
             "t:24:11: malformed XML: <child> is not closed before </joint> at line 25"},
        Slip{"<child link=\"sled\"/>", "<child link=\"sled\"",
             "t:24:11: malformed XML: the tag <child> is not finished"},
        Slip{"</argos-configuration>", "</argos>",
             "t:34:1: malformed XML: </argos> does not close <argos-configuration> of line 1"},
        Slip{"</argos-configuration>", "",
             "t:33:35: malformed XML: the file ends too early; close every element"},
        Slip{"<sensors/>", "<sensors/> 1 < 2", "t:9:20: malformed XML: this is no element"},
        Slip{"<sensors/>", "<sensors/> <!-- <x>", "t:9:18: malformed XML: this comment is not"}));

TEST(OtherFiles, AreNamed) {
  const auto fault = [](const char* text, const char* name) {
    const auto found = faults(read_text(text, name));
    return found.size() == 1 ? found[0] : testing::PrintToString(found);
  };
  EXPECT_EQ(fault("function step()\nend\n", "a.lua").substr(0, 27), "a.lua: this is a Lua script");
  EXPECT_EQ(fault("-- as <params> says\nfunction step() return 1 < 2 end\n", "a.lua").substr(0, 27),
            "a.lua: this is a Lua script");
  EXPECT_EQ(fault("{\"scene\": 1}", "a.json").substr(0, 23), "a.json: this is no XML;");
  EXPECT_EQ(fault("<sdf version='1.6'><world name='x'/></sdf>", "a.sdf").substr(0, 43),
            "a.sdf:1:1: <sdf> is the root of an SDF file");
  EXPECT_EQ(fault("<robot name='x'><link name='y'/></robot>", "a.urdf").substr(0, 46),
            "a.urdf:1:1: <robot> is the root of a URDF file");
  EXPECT_EQ(fault("<x><models><box id=\"b\" size=\"1,1,1\" movable=\"false\"/></models></x>", "m")
                .substr(0, 55),
            "m:1:1: <x> has models for scenes, but is no scene itsel");
}

TEST(OtherFiles, AreToldByTheirRootAndNotByWhatItLacks) {
  for (const char* text : {"<html><body>scene</body></html>", "<include file=\"x.argos\"/>"}) {
    const auto found = faults(read_text(text, "a"));
    ASSERT_EQ(found.size(), 1u) << text;
    EXPECT_NE(found[0].find("> is no scene: it has neither <framework> nor <arena>; a scene begins "
                            "with <argos-configuration>"),
              std::string::npos)
        << found[0];
  }
  const auto lacks = faults(read_text("<argos-config/>", "a"));
  ASSERT_FALSE(lacks.empty());
  EXPECT_NE(lacks[0].find("lacks the element <framework>"), std::string::npos) << lacks[0];
}

TEST(Radians, AreDoubtedOnceWithTheirNumber) {
  const auto warnings = [](const std::string& orientation) {
    std::string text = slider;
    for (const char* part : {"<body position=\"0,0,0\"/>", "<parent link=\"base\"/>"}) {
      const std::size_t at = text.find(part) + std::string(part).size() - 2;
      text.insert(at, " orientation=\"" + orientation + "\"");
    }
    const auto result = read_text(text, "t");
    EXPECT_TRUE(result.ok());
    return texts_of(result, Problem::Severity::warning);
  };
  const auto found = warnings("0, 1.57,0");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0],
            "t:15:43: orientation=\"0, 1.57,0\" of <body> looks like radians, and angles are in "
            "degrees; write 90 for 1.57 (in prototype \"slider\"); and 1 more like this");
  for (const char* radians : {"-3.1416,0,0", "0.785,0,0", "0,0,0.5236", "0,2.094,0", "6.283,0,0"}) {
    EXPECT_EQ(warnings(radians).size(), 1u) << radians;
  }
  for (const char* degrees :
       {"90,0,0", "1.5,0,0", "3.1,0,0", "0.52,0,0", "31.42,0,0", "0.25,0,0"}) {
    EXPECT_TRUE(warnings(degrees).empty()) << degrees;
  }
}

TEST(Limits, ThatLeaveOutTheAssembledPoseAreDoubted) {
  const auto warnings = [](const std::string& limit) {
    std::string text = slider;
    const std::string axis = "axis=\"1,0,0\"";
    text.insert(text.find(axis) + axis.size(), " limit=\"" + limit + "\"");
    return texts_of(read_text(text, "t"), Problem::Severity::warning);
  };
  ASSERT_EQ(warnings("0.1:0.2").size(), 1u);
  EXPECT_EQ(warnings("0.1:0.2")[0],
            "t:22:63: limit=\"0.1:0.2\" of <joint> leaves out 0, where the joint is assembled: it "
            "is moved into its limits as the run "
            "begins; measure limits from the assembled pose (in prototype \"slider\")");
  EXPECT_EQ(warnings("-0.2:-0.1").size(), 1u);
  EXPECT_TRUE(warnings("0:0.2").empty());
}

}  // namespace
}  // namespace ziggurat::scene
