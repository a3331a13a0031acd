// SPDX-License-Identifier: MIT
#include "simulation/scene_warnings.h"

#include <gtest/gtest.h>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::Base;
using testing::ground;
using testing::robot;
using testing::SmallScene;

std::string body(const std::string& id, const std::string& position, Base base = Base::free,
                 const std::string& size = "1,1,1") {
  return "<box id=\"" + id + "\" size=\"" + size + "\" movable=\"" +
         (base == Base::free ? "true" : "false") + "\"" +
         (base == Base::free ? " mass=\"1\"" : "") + "><body position=\"" + position +
         "\"/></box>\n";
}

std::vector<std::string> found(const std::string& arena, const std::string& engine = ground) {
  const scene::Scene scene = SmallScene{"", "", arena, engine}.read();
  std::vector<std::string> texts;
  for (const auto& problem : scene_warnings(scene, Simulation(scene, {1}))) {
    EXPECT_EQ(problem.severity, scene::Problem::Severity::warning);
    texts.push_back(scene::to_string(problem));
  }
  return texts;
}

void expect_one(const std::vector<std::string>& texts, const std::string& part) {
  ASSERT_EQ(texts.size(), 1u) << ::testing::PrintToString(texts);
  EXPECT_NE(texts[0].find(part), std::string::npos) << texts[0];
}

TEST(SceneWarnings, ALightStandsWhereItIs) {
  const auto light = [](const std::string& position) {
    return R"(<light id="l" color="red" intensity="1" medium="leds" position=")" + position +
           "\"/>";
  };
  EXPECT_TRUE(found(light("1,0,1")).empty());
  expect_one(found(light("9,0,1")), "light \"l\" begins outside of the arena");
}

TEST(SceneWarnings, AreNotRaisedBySoundScenes) {
  EXPECT_TRUE(found("").empty());
  EXPECT_TRUE(found(body("a", "0,0,0") + body("b", "1,0,0") + body("c", "0,0,1")).empty());
  EXPECT_TRUE(found(body("a", "0,0,0", Base::fixed) + body("b", "0.5,0,0", Base::fixed)).empty())
      << "walls may overlap";
  EXPECT_TRUE(found(body("a", "0,0,-0.5", Base::fixed)).empty()) << "a wall may stand in the floor";
  EXPECT_TRUE(found(body("a", "0,0,0"), "").empty()) << "without gravity nothing falls";
  EXPECT_TRUE(
      found(body("table", "0,0,-1", Base::fixed) + body("a", "0,0,0.5"), "<gravity g=\"9\"/>")
          .empty());
  EXPECT_TRUE(found(body("wall", "4.5,0,0", Base::fixed)).empty()) << "half of it is inside";
}

TEST(SceneWarnings, OverlapsAreCounted) {
  const auto texts = found(body("a", "0,0,0") + body("b", "0.9,0,0") + body("c", "-0.9,0,0"));
  expect_one(texts, "box \"b\" overlaps \"a\" at the start");
  EXPECT_TRUE(texts[0].ends_with("and 1 more like this")) << texts[0];
  EXPECT_EQ(texts[0].find("small.argos:2:1: "), 0u) << texts[0];
  expect_one(found(body("a", "0,0,0") + body("wall", "0.9,0,0", Base::fixed)),
             "box \"a\" overlaps \"wall\"");
}

TEST(SceneWarnings, OfBodiesInTheFloor) {
  expect_one(found(body("a", "0,0,-0.25")), "box \"a\" begins 0.25 m deep in the floor");
}

TEST(SceneWarnings, OfBodiesOutsideOfTheArena) {
  expect_one(found(body("a", "6,0,0")), "box \"a\" begins outside of the arena, at 6,0,0");
}

TEST(SceneWarnings, OfBodiesThatFallForever) {
  expect_one(found(body("a", "0,0,0"), "<gravity g=\"9\"/>"), "box \"a\" falls forever");
  expect_one(found(body("side", "2,0,-1", Base::fixed) + body("a", "0,0,0"), "<gravity g=\"9\"/>"),
             "box \"a\" falls forever");
}

TEST(SceneWarnings, OfMagnetsWithoutMagnetism) {
  const std::string magnet =
      R"(<prototype id="m" movable="true"><body position="0,0,0.1"/><links ref="l">)"
      R"(<link id="l" geometry="box" size=".1,.1,.1" mass="1"/></links><devices><magnets>)"
      R"(<magnet anchor="l" offset="0,0,0" passive_field="0,0,1"/></magnets></devices></prototype>)";
  expect_one(
      found(magnet),
      "prototype \"m\" has magnets that have no force; write <magnetism/> into <dynamics3d>");
  EXPECT_TRUE(found(magnet, ground + std::string("<magnetism/>")).empty());
}

TEST(SceneWarnings, OfLengthsInMillimetres) {
  expect_one(found(body("a", "0,0,0", Base::free, "100,100,100")),
             "is 100 m long, 11.1 times the arena");
  EXPECT_TRUE(found(body("a", "0,0,-20", Base::fixed, "100,100,20")).empty()) << "a ground";
}

TEST(SceneWarnings, OfJointsThatAreFarAway) {
  const auto arm = [](const std::string& x) {
    return R"(<prototype id="p" movable="true"><body position="0,0,0"/><links ref="a"><link id="a" geometry="box" size=".1,.1,.1" mass="1"/>)"
           R"(<link id="b" geometry="box" size=".1,.1,.1" mass="1" position="0.2,0,0"/></links><joints><joint id="j" type="revolute" axis="0,0,1">)"
           R"(<parent link="a" position=")" +
           x + R"(,0,0" orientation="0,0,0"/><child link="b" position=")" + x +
           R"(,0,0" orientation="0,0,0"/></joint></joints></prototype>)";
  };
  expect_one(found(arm("91")),
             "prototype \"p\" has joint \"j\" 91 m away from its link, 10.1 times the arena");
  EXPECT_TRUE(found(arm("0.1")).empty());
}

TEST(SceneWarnings, OfBodiesThatFloatWithoutGravity) {
  expect_one(found(body("a", "0,0,1"), "<floor/>"),
             "box \"a\" floats in the air: the scene has no gravity; write <gravity/> into "
             "<dynamics3d>, or <gravity g=\"0\"/>");
  EXPECT_TRUE(found(body("a", "0,0,1"), "<floor/><gravity g=\"0\"/>").empty())
      << "the scene says so";
  EXPECT_TRUE(found(body("a", "0,0,0") + body("b", "0,0,1"), "<floor/>").empty()) << "it stands";
  EXPECT_TRUE(found(body("a", "0,0,1", Base::fixed), "<floor/>").empty()) << "a wall";
}

std::string slider(const std::string& limit, const std::string& size) {
  return R"(<prototype id="p" movable="true"><body position="0,0,0"/><links ref="a"><link id="a" geometry="box" size=")" +
         size +
         R"(" mass="1"/><link id="b" geometry="box" size=".01,.01,.02" mass="1" position="0,0,.1"/></links><joints>)"
         R"(<joint id="j" type="prismatic" axis="0,0,1" limit=")" +
         limit +
         R"("><parent link="a" position="0,0,.1"/><child link="b"/></joint></joints></prototype>)";
}

TEST(SceneWarnings, OfLimitsAndLinksFarBeyondTheRobot) {
  expect_one(found(slider("0:100", ".1,.1,.1")),
             "has joint \"j\" with a limit of 100 m, 833 times the length of all of its links");
  EXPECT_TRUE(found(slider("0:1", ".1,.1,.1")).empty());
  expect_one(found(slider("0:1", "5,.1,.1")), "has link \"a\" of 5 m, 250 times its next longest");
  EXPECT_TRUE(found(slider("0:1", "3,.1,.1")).empty());
}

TEST(SceneWarnings, PacketsOfOtherSizesAreANotice) {
  const auto talker = [](const std::string& id, const std::string& x, const std::string& medium,
                         const std::string& size) {
    return robot(id, x + ",0,0",
                 R"(<range_and_bearing medium=")" + medium + R"(" anchor="base" data_size=")" +
                     size + R"("/>)");
  };
  const auto notices = [](const std::string& arena) {
    SmallScene small{R"(<range_and_bearing implementation="default"/>)", "", arena, ground};
    const scene::Scene scene = small.read();
    return scene_warnings(scene, Simulation(scene, {1}));
  };
  const auto found = notices(talker("a", "0", "rab", "10") + talker("b", "1", "rab", "2") +
                             talker("c", "2", "rab", "2"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].severity, scene::Problem::Severity::notice);
  EXPECT_EQ(
      found[0].text,
      "prototype \"b\" sends 2 bytes by range and bearing, and \"a\" on the same medium 10: they "
      "never hear each "
      "other; give them the same size (data_size, of robots rab_data_size); and 1 more like this");
  EXPECT_TRUE(notices(talker("a", "0", "rab", "10") + talker("b", "1", "through", "2")).empty());
}

/// A chain of twenty balls of 10 g on spherical joints with a last link of this mass [kg], which
/// leans by 20 degrees.
std::string chain(const std::string& last_mass) {
  std::string links = R"(<link id="base" geometry="box" size=".1,.1,.02" mass="1"/>)", joints;
  for (int i = 0; i <= 20; ++i) {
    const std::string id = std::to_string(i), parent = i == 0 ? "base" : std::to_string(i - 1);
    links += "<link id=\"" + id + R"(" geometry="sphere" radius=".02" mass=")" +
             (i < 20 ? ".01" : last_mass) + R"(" position="0,0,)" +
             std::to_string(-0.06 * (i + 1)) + R"(" orientation="0,0,0"/>)";
    joints += "<joint id=\"j" + id + R"(" type="spherical"><parent link=")" + parent +
              R"(" position="0,0,)" + (i == 0 ? "0" : "-.03") + R"("/><child link=")" + id +
              R"(" position="0,0,)" + (i == 0 ? ".06" : ".03") + R"("/></joint>)";
  }
  return R"(<prototype id="chain" movable="false"><body position="0,0,3" orientation="0,20,0"/><links ref="base">)" +
         links + "</links><joints>" + joints + "</joints></prototype>";
}

Simulation with_short_substeps(const std::string& arena) {
  std::string text = SmallScene{"", "", arena, R"(<gravity g="9.8"/>)"}.str();
  const std::string usual = R"(iterations="2")";
  text.replace(text.find(usual), usual.size(), R"(iterations="50")");
  return Simulation(scene::read_text(text, "small.argos").scene, {1});
}

TEST(SlowNotice, NamesWhatIsDividedAHundredTimesAndWhy) {
  Simulation world = with_short_substeps(body("falls", "3,0,9") + chain("100"));
  int ticks = 0;
  for (; ticks < 50 && !slow_notice(world); ++ticks) world.step();
  EXPECT_EQ(slow_notice(world).value_or(""),
            "'chain' makes the run slow: its substeps of 0.002 s are divided into 100 parts and "
            "more, because it is pulled harder, or "
            "turns faster, than they can follow; make the masses that hang on its joints lighter, "
            "or its links heavier");
  Simulation light = with_short_substeps(chain(".01"));
  testing::run(light, ticks);
  EXPECT_EQ(slow_notice(light), std::nullopt);
}

}  // namespace
}  // namespace ziggurat::simulation
