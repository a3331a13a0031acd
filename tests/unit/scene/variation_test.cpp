// SPDX-License-Identifier: MIT
// --set and --param: what the command line changes in a scene.

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "model_files.h"
#include "scene/parameters.h"
#include "scene/settings.h"
#include "scene_text.h"

namespace ziggurat::scene {
namespace {

ReadOptions set(std::initializer_list<const char*> settings) {
  ReadOptions options;
  for (const char* text : settings) {
    options.variation.settings.push_back(std::get<Setting>(to_setting(text)));
  }
  return options;
}

ReadOptions with_param(const char* name, const char* value) {
  ReadOptions options;
  options.variation.parameters = {{name, value}};
  return options;
}

SceneText boxes() {
  SceneText text;
  text.arena = R"(<arena size="2,2,2">
<box id="a" size="0.1,0.1,0.1" mass="1" movable="true"><body position="0,0,0"/></box>
<box id="b" size="0.1,0.1,0.1" mass="2" movable="true"><body position="1,0,0"/></box></arena>)";
  return text;
}

TEST(Set, ChangesAnAttribute) {
  const auto result = SceneText{}.read(set({"framework/experiment/@ticks_per_second=25"}));
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.experiment.ticks_per_second, 25u);
  EXPECT_TRUE(notices(result).empty());
}

TEST(Set, AddsAnAttributeThatTheReaderKnows) {
  const auto result = SceneText{}.read(set({"physics_engines/dynamics3d/@iterations=7"}));
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.physics.iterations, 7u);
}

TEST(Set, RefusesAnAttributeThatTheReaderDoesNotKnow) {
  EXPECT_EQ(only_fault(SceneText{}.read(set({"physics_engines/dynamics3d/@iteratons=7"}))),
            "test.argos:5:18: <dynamics3d> has an unknown attribute iteratons=\"7\"; did you mean "
            "\"iterations\"?; set by --set 'physics_engines/dynamics3d/@iteratons=7' (--lenient "
            "ignores it)");
}

TEST(Set, RefusesAValueThatTheReaderRefuses) {
  EXPECT_EQ(only_fault(boxes().read(set({"arena/box[@id='b']/@mass=-2"}))),
            "test.argos:6:1: mass=\"-2\" of <box> is negative; write more than 0 kg; set by "
            "--set 'arena/box[@id='b']/@mass=-2' (in box \"b\")");
}

TEST(Set, TellsHowManyItSets) {
  const auto result = boxes().read(set({"arena/box/@mass=3"}));
  EXPECT_TRUE(result.ok()) << all_problems(result);
  for (const Entity& box : result.scene.entities) EXPECT_EQ(box.links[0].mass, 3);
  EXPECT_EQ(notices(result),
            std::vector<std::string>{"test.argos: --set 'arena/box/@mass=3' sets 2 attributes"});
}

TEST(Set, FindsAttributesAnywhere) {
  const auto result = boxes().read(set({"//@mass=5"}));
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities[1].links[0].mass, 5);
}

TEST(Set, TheLastOneWins) {
  const auto result = boxes().read(set({"arena/box[1]/@mass=3", "arena/box[1]/@mass=4"}));
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 4);
}

TEST(Set, SaysWhichStepIsNotThere) {
  EXPECT_EQ(
      only_fault(boxes().read(set({"physics_engine/dynamics3d/@iterations=7"}))),
      "test.argos: --set 'physics_engine/dynamics3d/@iterations=7': the path matches nothing: "
      "there is no \"physics_engine\"; did you mean \"physics_engines\"?");
  EXPECT_EQ(only_fault(boxes().read(set({"arena/box[@id='c']/@mass=7"}))),
            "test.argos: --set 'arena/box[@id='c']/@mass=7': the path matches nothing: there is no "
            "\"box[@id='c']\"");
  for (const char* path :
       {"//tower/@mass", "/argos-configuration/tower/@mass", "//*[1]/tower/@mass"}) {
    EXPECT_NE(
        only_fault(boxes().read(set({(std::string(path) + "=7").c_str()}))).find("no \"tower\""),
        std::string::npos)
        << path;
  }
}

TEST(Set, SaysThatAttributesBeginWithAt) {
  EXPECT_EQ(only_fault(boxes().read(set({"arena/box[@id='b']/mass=7"}))),
            "test.argos: --set 'arena/box[@id='b']/mass=7': the path matches nothing: \"mass\" is "
            "an attribute, and its "
            "name begins with @: write @mass");
  EXPECT_EQ(only_fault(boxes().read(set({"physics_engines/dynamics3d/iterations=7"}))),
            "test.argos: --set 'physics_engines/dynamics3d/iterations=7': the path matches "
            "nothing: \"iterations\" is no "
            "element, and the path names no attribute: let it end with /@NAME");
}

TEST(Set, RefusesWhatIsNoPathToAttributes) {
  for (const char* text : {"arena=1", "count(arena)=1", "'arena'=3", "arena/box/text()=3", "/=1"}) {
    EXPECT_NE(only_fault(boxes().read(set({text}))).find("the path "), std::string::npos) << text;
  }
  EXPECT_NE(only_fault(boxes().read(set({"arena/!/@x=2"}))).find("is no XPath"), std::string::npos);
}

TEST(Set, RefusesPathsThatWouldTakeForEver) {
  const auto fault_of = [](const std::string& text) {
    return only_fault(boxes().read(set({text.c_str()})));
  };
  EXPECT_NE(
      fault_of("//*[count(//*[count(//*)>0])>0]/@mass=1").find("[conditions] in [conditions]"),
      std::string::npos);
  for (const char* path : {"//*[following::*]", "//*/following::*", "//*/preceding::*",
                           "arena/*/following-sibling::*"}) {
    EXPECT_NE(fault_of(std::string(path) + "/@x=1").find("an axis (::)"), std::string::npos)
        << path;
  }
  for (const char* path : {"//*//*", "//*/..//*", "//*|//*", "*//*//@x/.."}) {
    EXPECT_NE(fault_of(std::string(path) + "/@x=1").find("// more than once"), std::string::npos)
        << path;
  }
  EXPECT_NE(fault_of("arena/*/../*/../*/../*/../box/@mass=1").find(".. more than three times"),
            std::string::npos);
  for (const char* path : {"//*[count(//*/..//*/..//*)>0]", "//*[../*]", "//*[.//*]", "//*[/*/*]",
                           "//*[@a and /*/*]", "//*[@a and/*/*]", "//*[2*/*/*]", "//*[1-/*/*]",
                           "arena[*/@x=*/@y]", "arena['1'=*/@y]", "arena[]"}) {
    EXPECT_NE(fault_of(std::string(path) + "/@x=1").find("has the condition ["), std::string::npos)
        << path;
  }
  EXPECT_NE(fault_of(std::string(2000, 'a') + "/@mass=1").find("at most 1024"), std::string::npos);
  for (const char* path :
       {"arena/box[@id='a' or @id='[[::..//'][body/@position]",
        "arena/box[@id='a']/../box[@id='b'][body]", "arena/box[last()]", "arena/box[2]",
        "//box[ not(@id = \"b\") and count(*) >= 1 ]", "arena/box[starts-with(@id, 'a')]",
        "arena/box[position()<2][./body/@position]", "(//box)[1]"}) {
    const auto result = boxes().read(set({(std::string(path) + "/@mass=1").c_str()}));
    EXPECT_TRUE(result.ok()) << path << all_problems(result);
  }
}

TEST(Set, ReachesIncludedFiles) {
  const auto result = using_block(R"(<prototype id="a" model="block"><body/></prototype>)",
                                  "<include file=\"parts/block.argos\"/>")
                          .read([] {
                            ReadOptions options = options_with({{"parts/block.argos", block}});
                            options.variation =
                                set({"models/prototype[@id='block']//link[1]/@mass=0.5"}).variation;
                            return options;
                          }());
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 0.5);
}

TEST(Set, SplitsAtTheFirstEqualsSignOutsideOfBracketsAndQuotes) {
  const auto path_of = [](const char* text) { return std::get<Setting>(to_setting(text)).path; };
  EXPECT_EQ(path_of("a/b[@id='x=y']/@c=1=2"), "a/b[@id='x=y']/@c");
  EXPECT_EQ(std::get<Setting>(to_setting("a/@c=1=2")).value, "1=2");
  EXPECT_EQ(std::get<Setting>(to_setting("a/@c=")).value, "");
  for (const char* text : {"", "a/@c", "=1", "a[b=1]"}) {
    EXPECT_TRUE(std::holds_alternative<Wrong>(to_setting(text))) << text;
  }
}

SceneText with_parameters_of_boxes() {
  SceneText text = boxes();
  text.rest = "<parameters m=\"2.5\" side=\"0.1\"/>\n";
  text.arena = R"(<arena size="2,2,2">
<box id="${side}" size="0.2,${side},0.1" mass="${m}" movable="true"><body position="0,0,0"/></box></arena>)";
  return text;
}

TEST(Parameters, StandForTheirValues) {
  const auto result = with_parameters_of_boxes().read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 2.5);
  EXPECT_EQ(result.scene.entities[0].id, "0.1");
}

TEST(Parameters, AreGivenByTheCommandLine) {
  const auto result = with_parameters_of_boxes().read(with_param("m", "4"));
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 4);
}

TEST(Parameters, AreNamedInFaults) {
  EXPECT_EQ(only_fault(with_parameters_of_boxes().read(with_param("m", "-4"))),
            "test.argos:5:48: mass=\"${m}\" of <box> is negative; write more than 0 kg; with its "
            "parameters it is \"-4\" (in box \"0.1\")");
}

TEST(Parameters, MustBeDeclared) {
  EXPECT_EQ(only_fault(boxes().read(with_param("m", "4"))),
            "test.argos:1:1: --param m=4: the scene has no parameters; write <parameters m=\"4\"/> "
            "into <argos-configuration>");
  EXPECT_EQ(only_fault(with_parameters_of_boxes().read(with_param("sied", "4"))),
            "test.argos:1:1: --param sied=4: the scene has no such parameter; did you mean "
            "\"side\"?");
  SceneText unknown = boxes();
  unknown.framework = R"(<framework><experiment ticks_per_second="${hz}"/></framework>)";
  EXPECT_NE(only_fault(unknown.read()).find("write <parameters hz=\"…\"/>"), std::string::npos);
}

TEST(Parameters, AreNotMadeOfOthers) {
  for (const char* name : {"m", "nowhere"}) {
    SceneText text = boxes();
    text.rest = "<parameters m='2' n='${" + std::string(name) + "}'/>\n";
    const std::string fault = only_fault(text.read());
    EXPECT_NE(
        fault.find(
            "values in <parameters> are not made of other parameters; write the value itself"),
        std::string::npos)
        << fault;
  }
}

TEST(Parameters, ADoubledDollarIsOne) {
  Parameters parameters;
  parameters.declare("a", "1");
  EXPECT_EQ(std::get<0>(expand("$${a} ${a}$a$", parameters)), "${a} 1$a$");
  EXPECT_TRUE(std::holds_alternative<Wrong>(expand("${a", parameters)));
  EXPECT_TRUE(std::holds_alternative<Wrong>(expand("${b}", parameters)));
  Parameters large;
  large.declare("a", std::string(1000, 'x'));
  std::string text;
  for (int i = 0; i < 2000; ++i) text += "${a}";
  EXPECT_TRUE(std::holds_alternative<Wrong>(expand(text, large)));
}

TEST(Parameters, ReachControllers) {
  SceneText text;
  text.rest = "<parameters gain=\"2\" speed=\"5\"/>\n";
  text.controllers = R"(<controllers><lua_controller id="c"><actuators/><sensors/>
<params script="x.lua" speed="3" half="${speed}"/></lua_controller></controllers>)";
  using Params = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(text.read().scene.controllers[0].params,
            (Params{{"script", "x.lua"}, {"speed", "3"}, {"half", "5"}, {"gain", "2"}}));
  EXPECT_EQ(text.read(with_param("speed", "9")).scene.controllers[0].params,
            (Params{{"script", "x.lua"}, {"speed", "9"}, {"half", "9"}, {"gain", "2"}}));
}

/// `a0="${value}" a1="${value}" …`
std::string many_attributes(int count, const std::string& value) {
  std::string text;
  for (int i = 0; i < count; ++i) text += " a" + std::to_string(i) + "=\"" + value + "\"";
  return text;
}

TEST(Parameters, ManyTakeATimeInProportion) {
  SceneText text;
  text.rest = "<parameters" + many_attributes(100'000, "1") + "/>\n";
  text.controllers = R"(<controllers><lua_controller id="c"><actuators/><sensors/><params)" +
                     many_attributes(100'000, "${a99999}") + "/></lua_controller></controllers>";
  const auto begin = std::chrono::steady_clock::now();
  const auto result = text.read();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.controllers[0].params.size(), 100'000u);
  EXPECT_EQ(result.scene.controllers[0].params[7].second, "1");
  EXPECT_LT(taken.count(), 10) << "a minute where each is compared with all";
}

TEST(Parameters, OfOneElementAre100000AtMost) {
  SceneText text;
  text.rest = "<parameters" + many_attributes(100'001, "1") + "/>\n";
  EXPECT_EQ(only_fault(text.read()),
            "test.argos:7:1: <parameters> has more than 100000 attributes; write fewer");
}

}  // namespace
}  // namespace ziggurat::scene
