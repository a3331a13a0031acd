// Models that many entities share, and the files that contain them.

#include <gtest/gtest.h>

#include <ctime>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

using Files = std::map<std::string, std::string>;

/// Reads from memory only: paths as written are the files' identities.
ReadOptions options_with(Files files) {
  ReadOptions options;
  options.open = [files = std::move(files)](
                     const std::filesystem::path& path,
                     std::size_t max_size) -> std::variant<File, std::string> {
    const auto found = files.find(path.string());
    if (found == files.end()) return "does not exist; check its path";
    if (found->second.size() > max_size) return "is larger than it may be";
    return File{path.string(), found->second};
  };
  return options;
}

constexpr const char* block =
    "<ziggurat-models>\n"
    "<controllers>\n"
    "<lua_controller id=\"blink\"><actuators><leds implementation=\"default\" medium=\"leds\"/>"
    "</actuators><sensors/><params script=\"blink.lua\"/></lua_controller>\n"
    "</controllers>\n"
    "<models>\n"
    "<prototype id=\"block\">\n"
    "<links ref=\"core\">\n"
    "<link id=\"core\" geometry=\"box\" size=\"1,1,1\" mass=\"2\"/>\n"
    "<link id=\"pole\" geometry=\"sphere\" radius=\"0.1\" mass=\"1\"/>\n"
    "</links>\n"
    "<joints><joint id=\"j\" type=\"spherical\"><parent link=\"core\"/><child link=\"pole\"/>"
    "</joint></joints>\n"
    "<devices>\n"
    "<leds medium=\"leds\"><led anchor=\"pole\" offset=\"1,2,3\" color=\"red\"/></leds>\n"
    "</devices>\n"
    "<controller config=\"blink\"><params script=\"own.lua\"/></controller>\n"
    "</prototype>\n"
    "</models>\n"
    "</ziggurat-models>\n";

constexpr const char* include_block = "<include file=\"parts/block.argos\"/>";

SceneText using_block(const std::string& elements, const std::string& rest = include_block) {
  SceneText text;
  text.media = "<media><led id=\"leds\"/><tag id=\"tags\"/></media>";
  text.controllers =
      "<controllers><external_controller id=\"other\"><actuators/><sensors/></external_controller>"
      "</controllers>";
  text.arena = "<arena size=\"2,2,2\">\n" + elements + "</arena>";
  text.rest = rest + "\n";
  return text;
}

ReadResult read_block(const std::string& elements) {
  return using_block(elements).read(options_with({{"parts/block.argos", block}}));
}

TEST(Models, DefineTheEntitiesThatUseThem) {
  const ReadResult result =
      read_block(R"(<prototype id="a" model="block"><body position="1,2,3"/></prototype>)"
                 R"(<prototype id="b" model="block"><body orientation="90,0,0"/></prototype>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.entities.size(), 2u);
  EXPECT_EQ(scene.entities[0].id, "a");
  EXPECT_EQ(scene.entities[0].pose.position, math::Vector3(1, 2, 3));
  EXPECT_EQ(scene.entities[0].where.line, 5u);
  EXPECT_EQ(scene.entities[0].where.file, 0u);
  EXPECT_EQ(scene.entities[1].pose.position, math::Vector3(0, 0, 0));
  for (const Entity& entity : scene.entities) {
    EXPECT_EQ(entity.kind, EntityKind::prototype);
    EXPECT_TRUE(entity.movable);
    ASSERT_EQ(entity.links.size(), 2u);
    EXPECT_EQ(entity.links[0].mass, 2.0);
    EXPECT_EQ(entity.links[1].where.line, 9u);
    EXPECT_EQ(entity.links[1].where.file, 1u);
    ASSERT_EQ(entity.joints.size(), 1u);
    EXPECT_EQ(entity.joints[0].child, 1u);
    ASSERT_EQ(entity.devices.leds.size(), 1u);
    EXPECT_EQ(entity.devices.leds[0].anchor.link, 1);
    EXPECT_EQ(entity.devices.led_medium, 0u);
    EXPECT_EQ(entity.model, 0u);
  }
  ASSERT_EQ(scene.models.size(), 1u);
  EXPECT_EQ(scene.models[0].id, "block");
  EXPECT_EQ(scene.models[0].where.line, 6u);
  EXPECT_EQ(scene.files, (std::vector<std::string>{"test.argos", "parts/block.argos"}));
}

TEST(Models, GiveTheSameEntityAsTheWrittenOutText) {
  const std::string parts =
      R"(<links ref="l"><link id="l" geometry="box" size="1,2,3" mass="4" friction="0.1"/></links>)"
      R"(<devices><tags medium="tags"><tag anchor="l" position="1,1,1" orientation="1,2,3" )"
      R"(observable_angle="40" side_length="0.2" payload="p"/></tags></devices>)";
  const ReadResult result =
      using_block(R"(<prototype id="a" model="m"><body position="0,0,1"/></prototype>)"
                  R"(<prototype id="b"><body position="0,0,1"/>)" +
                      parts + "</prototype>",
                  "<models><prototype id=\"m\">" + parts + "</prototype></models>")
          .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Entity &a = result.scene.entities[0], &b = result.scene.entities[1];
  EXPECT_EQ(std::get<Box>(a.links[0].geometry).size, std::get<Box>(b.links[0].geometry).size);
  EXPECT_EQ(a.links[0].mass, b.links[0].mass);
  EXPECT_EQ(a.links[0].surface.friction, b.links[0].surface.friction);
  EXPECT_EQ(a.links[0].damping.linear, b.links[0].damping.linear);
  EXPECT_EQ(a.devices.tag_medium, b.devices.tag_medium);
  EXPECT_EQ(a.devices.tags[0].payload, b.devices.tags[0].payload);
  EXPECT_EQ(a.devices.tags[0].pose.orientation.coeffs(),
            b.devices.tags[0].pose.orientation.coeffs());
  EXPECT_EQ(a.pose.position, b.pose.position);
  EXPECT_FALSE(b.model);
}

TEST(Models, AnEntitysControllerReplacesTheModels) {
  const ReadResult result = read_block(
      R"(<prototype id="a" model="block"><body/></prototype>)"
      R"(<prototype id="b" model="block"><body/><controller config="other"/></prototype>)"
      R"(<prototype id="c" model="block"><body/><controller config="blink"><params x="1"/></controller></prototype>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.controllers.size(), 2u);
  EXPECT_EQ(scene.controllers[0].id, "other") << "the scene's own come first";
  EXPECT_EQ(scene.controllers[1].id, "blink");
  EXPECT_EQ(scene.controllers[1].params_where.file, 1u);
  const Entity &a = scene.entities[0], &b = scene.entities[1], &c = scene.entities[2];
  using Params = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(a.controller, 1u);
  EXPECT_TRUE(a.overrides_params);
  EXPECT_EQ(a.params, (Params{{"script", "own.lua"}}));
  EXPECT_EQ(a.params_where.file, 1u);
  EXPECT_EQ(a.params_where.line, 15u);
  EXPECT_EQ(b.controller, 0u);
  EXPECT_FALSE(b.overrides_params) << "the model's <params> belong to the model's controller";
  EXPECT_TRUE(b.params.empty());
  EXPECT_EQ(c.controller, 1u);
  EXPECT_EQ(c.params, (Params{{"x", "1"}}));
  EXPECT_EQ(c.params_where.file, 0u);
}

TEST(Models, MovableCanBeOverridden) {
  const std::string models =
      R"(<models><box id="crate" size="1,1,1" movable="true" mass="3"/>)"
      R"(<cylinder id="post" radius="1" height="2" movable="false"/></models>)";
  const ReadResult result = using_block(R"(<box id="a" model="crate"><body/></box>)"
                                        R"(<box id="b" model="crate" movable="false"><body/></box>)"
                                        R"(<cylinder id="c" model="post"><body/></cylinder>)",
                                        models)
                                .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_TRUE(result.scene.entities[0].movable);
  EXPECT_EQ(result.scene.entities[0].links[0].mass, 3.0);
  EXPECT_FALSE(result.scene.entities[1].movable);
  EXPECT_EQ(result.scene.entities[1].links[0].mass, 0.0);
  EXPECT_FALSE(result.scene.entities[2].movable);
  const auto wrong = faults(
      using_block("<cylinder id=\"c\" model=\"post\" movable=\"true\"><body/></cylinder>", models)
          .read());
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_EQ(wrong[0].find("test.argos:5:40: movable=\"true\" of <cylinder> needs a mass"), 0u)
      << wrong[0];
}

TEST(Models, FootBotAndEPuckCanBeModels) {
  const std::string rest =
      R"(<models><foot-bot id="rover" rab_range="2"><controller config="driver"/></foot-bot></models>)";
  SceneText text = using_block(
      R"(<foot-bot id="a" model="rover"><body position="1,2,0"/></foot-bot>)"
      R"(<foot-bot id="b" model="rover" movable="false"><body/><controller config="other"/></foot-bot>)",
      rest);
  text.media = R"(<media><led id="leds"/><led id="lamps"/><range_and_bearing id="rab"/></media>)";
  text.controllers =
      R"(<controllers><external_controller id="other"><actuators/><sensors/></external_controller>)"
      R"(<external_controller id="driver"><actuators><leds implementation="default" medium="lamps"/>)"
      R"(<differential_steering implementation="default"/></actuators><sensors/>)"
      R"(</external_controller></controllers>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.entities.size(), 2u);
  for (const Entity& robot : scene.entities) {
    EXPECT_EQ(robot.kind, EntityKind::foot_bot);
    EXPECT_EQ(robot.model, 0u);
    EXPECT_EQ(robot.links.at(0).mass, 1.6) << "a robot that stands still keeps its mass";
    EXPECT_EQ(robot.turret, 1u);
    EXPECT_EQ(robot.devices.leds.size(), 13u);
    EXPECT_EQ(robot.devices.range_and_bearing->range, 2);
    EXPECT_EQ(robot.devices.range_and_bearing_medium, 2u);
  }
  const Entity &a = scene.entities[0], &b = scene.entities[1];
  EXPECT_TRUE(a.movable);
  EXPECT_EQ(a.pose.position, math::Vector3(1, 2, 0));
  ASSERT_EQ(a.controller, 1u);
  EXPECT_EQ(scene.controllers[1].devices.leds->medium, 1u);
  EXPECT_FALSE(b.movable);
  EXPECT_EQ(b.controller, 0u);
  text.arena = R"(<arena size="2,2,2"><foot-bot id="a" model="rover"><body/></foot-bot></arena>)";
  text.rest = R"(<models><foot-bot id="rover"/></models>)";
  EXPECT_EQ(count_containing(faults(text.read()), "<foot-bot> lacks the element <controller>"), 1u)
      << "neither the model nor the entity has one";
}

TEST(Models, CanBeDistributed) {
  const ReadResult result = read_block(
      R"(<distribute><position method="uniform" min="0,0,0" max="9,9,9"/>)"
      R"(<orientation method="constant" values="0,0,0"/>)"
      R"(<entity quantity="40" max_trials="10"><prototype id="b" model="block"/></entity></distribute>)");
  ASSERT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.distributions.size(), 1u);
  const Distribution& group = result.scene.distributions[0];
  EXPECT_EQ(group.quantity, 40u);
  EXPECT_EQ(group.entity.id, "b");
  EXPECT_EQ(group.entity.model, 0u);
  EXPECT_EQ(group.entity.links.size(), 2u);
  EXPECT_EQ(group.entity.controller, 1u);
}

TEST(Models, FortyBlocksAreReadAtOnce) {
  std::string devices, elements;
  for (int i = 0; i < 24; ++i) {
    devices += R"(<directional_led anchor="core" position="0.1,0.2,0.3" orientation="0,90,0" )"
               R"(observable_angle="75" color="black"/>)";
  }
  for (int i = 0; i < 40; ++i) {
    elements += "<prototype id=\"b" + std::to_string(i) + R"(" model="b"><body position="0,0,)" +
                std::to_string(i) + "\"/></prototype>\n";
  }
  SceneText text =
      using_block(elements,
                  "<models><prototype id=\"b\"><links ref=\"core\"><link id=\"core\" "
                  "geometry=\"box\" size=\"1,1,1\" mass=\"1\"/></links><devices><directional_leds "
                  "medium=\"dirs\">" +
                      devices + "</directional_leds></devices></prototype></models>");
  text.media = "<media><directional_led id=\"dirs\"/></media>";
  double least = 1e9;  // [s] of several: the first one fills the caches
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();  // processor time: the machine may be busy
    const ReadResult result = text.read();
    least = std::min(least, double(std::clock() - start) / CLOCKS_PER_SEC);
    ASSERT_TRUE(result.ok()) << all_problems(result);
    ASSERT_EQ(result.scene.entities[39].devices.directional_leds.size(), 24u);
  }
  RecordProperty("milliseconds", std::to_string(least * 1e3));
  EXPECT_LT(least, 0.05);
}

// --- faults, each at its place -------------------------------------------------------------------

struct Row {
  const char* name;
  const char* elements;  ///< of the arena, from line 5 on
  const char* rest;      ///< at the root, from line 9 on: after the arena's and media
  const char* expected;  ///< begin of the only fault
};
std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

class ModelFault : public testing::TestWithParam<Row> {};

TEST_P(ModelFault, IsFoundAtItsPlace) {
  const Row& row = GetParam();
  const auto deep = [](int i) { return "deep" + std::to_string(i); };
  Files files{{"parts/block.argos", block},
              {"parts/same.argos", "<m><include file=\"block.argos\"/></m>"},
              {"self", "<m>\n<include file=\"self\"/></m>"},
              {"a", "<m><include file=\"b\"/></m>"},
              {"b", "<m><include file=\"a\"/></m>"},
              {"again",
               "<m><models><prototype id=\"block\"><links ref=\"l\"><link id=\"l\" "
               "geometry=\"sphere\" radius=\"1\" mass=\"1\"/></links></prototype></models></m>"},
              {"other", "<m><controllers>\n<external_controller id=\"other\"/></controllers></m>"},
              {"arena", "<m>\n<arena size=\"1,1,1\"/></m>"},
              {"back", "<m><include file=\"test.argos\"/></m>"},
              {"test.argos", "the text that is read"},
              {"bad", "<a>\n<b></a>"},
              {"empty", " "}};
  for (int i = 0; i < 20; ++i) {
    files[deep(i)] = "<m><include file=\"" + deep(i + 1) + "\"/></m>";
  }
  const ReadResult result =
      using_block(row.elements, row.rest).read(options_with(std::move(files)));
  const auto texts = faults(result);
  ASSERT_EQ(texts.size(), 1u) << all_problems(result);
  EXPECT_EQ(texts[0].find(row.expected), 0u) << "expected: " << row.expected << "\n"
                                             << all_problems(result);
}

constexpr Row rows[] = {
    {"NoModels", "<box id=\"a\" model=\"crate\"><body/></box>", "",
     "test.argos:5:20: model=\"crate\" of <box> names no model; define it in <models>"},
    {"Misspelt", "<prototype id=\"a\" model=\"blok\"><body/></prototype>", include_block,
     "test.argos:5:26: model=\"blok\" of <prototype> names no model; did you mean \"block\"?"},
    {"OtherElement", "<box id=\"a\" model=\"block\"><body/></box>", include_block,
     "test.argos:5:20: model=\"block\" of <box> is a <prototype>, defined at "
     "parts/block.argos:6:1; write <prototype model=\"block\" …>"},
    {"Links", "<prototype id=\"a\" model=\"block\"><body/>\n<links ref=\"l\"/></prototype>",
     include_block,
     "test.argos:6:1: <links> can't stand in this <prototype>: the model says it, at "
     "parts/block.argos:6:1; an entity of it says id, model, movable, <body> and <controller> (in "
     "prototype \"a\" of model \"block\")"},
    {"Devices", "<prototype id=\"a\" model=\"block\"><body/><devices/></prototype>", include_block,
     "test.argos:5:40: <devices> can't stand in this <prototype>"},
    {"Attribute", "<prototype id=\"a\" model=\"block\" friction=\"1\"><body/></prototype>",
     include_block,
     "test.argos:5:33: the attribute friction=\"1\" can't stand in this <prototype>: the model"},
    {"NoBody", "<prototype id=\"a\" model=\"block\"/>", include_block,
     "test.argos:5:1: <prototype> lacks the element <body>"},
    {"EmptyName", "<prototype id=\"a\" model=\"\"><body/></prototype>", include_block,
     "test.argos:5:26: model=\"\" of <prototype> "},
    {"UnknownController",
     "<prototype id=\"a\" model=\"block\"><body/><controller config=\"blnk\"/></prototype>",
     include_block,
     "test.argos:5:60: config=\"blnk\" of <controller> names no controller; did you mean"},
    {"SecondModel", "", "<include file=\"parts/block.argos\"/><include file=\"again\"/>",
     "again:1:27: id=\"block\" of <prototype> is the id of the model at parts/block.argos:6:1"},
    {"SecondController", "", "<include file=\"other\"/>",
     "other:2:26: id=\"other\" of <external_controller> is the id of the controller at "
     "test.argos:3:14; give each its own"},
    {"Missing", "", "<include file=\"parts/blok.argos\"/>",
     "test.argos:8:16: file=\"parts/blok.argos\" of <include> names \"parts/blok.argos\", which "
     "does not exist"},
    {"NoFile", "", "<include/>", "test.argos:8:1: <include> lacks the attribute file"},
    {"Cycle", "", "<include file=\"a\"/>",
     "b:1:19: file=\"a\" of <include> closes a cycle: a includes b includes a; remove one"},
    {"Self", "", "<include file=\"self\"/>",
     "self:2:16: file=\"self\" of <include> closes a cycle: self includes self"},
    {"TheScene", "", "<include file=\"test.argos\"/>",
     "test.argos:8:16: file=\"test.argos\" of <include> closes a cycle"},
    {"TheSceneFromAfar", "", "<include file=\"back\"/>",
     "back:1:19: file=\"test.argos\" of <include> closes a cycle: test.argos includes back"},
    {"Deep", "", "<include file=\"deep0\"/>",
     "deep15:1:19: file=\"deep16\" of <include> is nested too deep; includes may lead over 16 "
     "files"},
    {"Arena", "", "<include file=\"arena\"/>",
     "arena:2:1: <arena> can't stand in this <m>: a file that is included has <include>, <models>"},
    {"Malformed", "", "<include file=\"bad\"/>", "bad:2:6: malformed XML"},
    {"Empty", "", "<include file=\"empty\"/>", "empty: the file is empty"},
    {"InTheArena", "<include file=\"parts/block.argos\"/>", "",
     "test.argos:5:1: unknown element <include> in <arena>"},
    {"Unknown", "", "<models><boxx id=\"b\"/></models>",
     "test.argos:8:9: unknown element <boxx> in <models>; did you mean \"box\"?"},
    {"NoId", "", "<models><box size=\"1,1,1\" movable=\"false\"/></models>",
     "test.argos:8:9: <box> lacks the attribute id"},
    {"Body", "", "<models><box id=\"b\" size=\"1,1,1\" movable=\"false\"><body/></box></models>",
     "test.argos:8:50: <body> can't stand in a model: each of its entities has its own"},
    {"ModelOfModel", "",
     "<models><box id=\"b\" size=\"1,1,1\" movable=\"false\" model=\"c\"/></models>",
     "test.argos:8:57: model=\"c\" of <box> can't stand in a definition"},
    {"BadLink",
     "<prototype id=\"a\" model=\"b\"><body/></prototype>\n"
     "<prototype id=\"c\" model=\"b\"><body/></prototype>",
     "<models><prototype id=\"b\"><links ref=\"l\"><link id=\"l\" geometry=\"sphere\" "
     "radius=\"-1\" mass=\"1\"/></links></prototype></models>",
     "test.argos:9:81: radius=\"-1\" of <link> "},
    {"ModelsController",
     "<prototype id=\"a\" model=\"b\"><body/></prototype>\n"
     "<prototype id=\"c\" model=\"b\"><body/></prototype>",
     "<models><prototype id=\"b\"><links ref=\"l\"><link id=\"l\" geometry=\"sphere\" radius=\"1\" "
     "mass=\"1\"/></links>\n<controller config=\"none\"/></prototype></models>",
     "test.argos:10:21: config=\"none\" of <controller> names no controller; known here: other (in "
     "prototype \"a\" of model \"b\")"},
};
INSTANTIATE_TEST_SUITE_P(All, ModelFault, testing::ValuesIn(rows),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Models, AMissingMediumIsAFaultOnceTheModelIsUsed) {
  const Files files{{"parts/block.argos", block}};
  SceneText text = using_block("");
  text.media = "<media/>";
  EXPECT_TRUE(text.read(options_with(files)).ok()) << "no entity uses the model";
  text = using_block(
      "<prototype id=\"a\" model=\"block\"><body/></prototype>\n"
      "<prototype id=\"b\" model=\"block\"><body/></prototype>\n");
  text.media = "<media><led id=\"lamps\"/></media>";
  EXPECT_EQ(faults(text.read(options_with(files))),
            (std::vector<std::string>{
                "parts/block.argos:3:78: medium=\"leds\" of <leds> names no medium of the scene; "
                "write <led id=\"leds\"/> in <media> (in prototype \"a\" of model \"block\")",
                "parts/block.argos:13:15: medium=\"leds\" of <leds> names no medium of the scene; "
                "write <led id=\"leds\"/> in <media> (in prototype \"a\" of model \"block\")"}));
  text.media = "<media><tag id=\"leds\"/></media>";
  EXPECT_EQ(count_containing(faults(text.read(options_with(files))),
                             "names a medium of type tag; name a led medium"),
            2u);
}

TEST(Models, FaultsOfAControllerAreReportedOnceForAllEntities) {
  std::string elements;
  for (int i = 0; i < 40; ++i) {
    elements += "<prototype id=\"b" + std::to_string(i) + "\" model=\"block\"><body/></prototype>";
  }
  std::string wrong = block;
  wrong.replace(wrong.find("<leds imp"), 5, "<tags");
  wrong.replace(wrong.find(" medium=\"leds\"/>"), 14, "");
  const auto found =
      faults(using_block(elements).read(options_with({{"parts/block.argos", wrong}})));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].find("parts/block.argos:3:39: tags are enabled for entity \"b0\", which has "
                         "none; write <tags> into its <devices>"),
            0u)
      << found[0];
}

TEST(Models, CountAsWrittenOutInTheScenesSize) {
  std::string elements;
  for (int i = 0; i < 40; ++i) {
    elements +=
        "<prototype id=\"b" + std::to_string(i) + "\" model=\"block\"><body/></prototype>\n";
  }
  ReadOptions options = options_with({{"parts/block.argos", block}});
  options.max_size = 1u << 20;
  EXPECT_TRUE(using_block(elements).read(options).ok());
  options.max_size = 10'000;
  const ReadResult result = using_block(elements).read(options);
  const auto found = faults(result);
  ASSERT_EQ(found.size(), 1u) << all_problems(result);
  EXPECT_NE(found[0].find("the scene is larger than 10000 bytes"), std::string::npos) << found[0];
  options.max_size = using_block(elements).str().size() + std::string(block).size();
  EXPECT_EQ(faults(using_block(elements).read(options)).size(), 1u) << "no byte remains for models";
}

// --- files ---------------------------------------------------------------------------------------

TEST(Includes, AFileWithTwoPathsIsReadOnce) {
  const ReadResult result =
      using_block(R"(<prototype id="a" model="block"><body/></prototype>)",
                  "<include file=\"parts/same.argos\"/><include file=\"./parts/block.argos\"/>"
                  "<include file=\"parts/../parts/block.argos\"/>")
          .read(options_with({{"parts/block.argos", block},
                              {"parts/same.argos", "<m><include file=\"block.argos\"/></m>"}}));
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.files,
            (std::vector<std::string>{"test.argos", "parts/same.argos", "parts/block.argos"}));
}

TEST(Includes, TooManyAreAFault) {
  std::string includes;
  for (int i = 0; i < 1010; ++i) includes += "<include file=\"parts/block.argos\"/>";
  const auto found =
      faults(using_block("", includes).read(options_with({{"parts/block.argos", block}})));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("is one too many; a scene has at most 1000"), std::string::npos);
}

TEST(Includes, AreCheckedForSizeAfterOpening) {
  ReadOptions options;
  options.open = [](const auto&, std::size_t) -> std::variant<File, std::string> {
    return File{"big", std::string(1u << 20, ' ')};
  };
  options.max_size = 10'000;
  const auto found = faults(using_block("").read(options));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("is larger than "), std::string::npos);
}

TEST(Includes, FromDiskPathsStartAtTheIncludingFile) {
  char pattern[] = "/tmp/ziggurat-models-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(pattern);
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "models/blocks");
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("models/all.argos", "<m><include file=\"blocks/block.argos\"/></m>");
  write("models/blocks/block.argos", block);
  std::filesystem::create_symlink(folder / "models/blocks/block.argos", folder / "scenes/link");
  write("scenes/a.argos",
        using_block(R"(<prototype id="a" model="block"><body/></prototype>)",
                    "<include file=\"../models/all.argos\"/><include file=\"link\"/>")
            .str());
  write("scenes/cycle.argos", using_block("", "<include file=\"./cycle.argos\"/>").str());
  write("scenes/folder.argos", using_block("", "<include file=\"../models\"/>").str());
  const ReadResult result = read_file(folder / "scenes/a.argos");
  EXPECT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.files.size(), 3u);
  EXPECT_EQ(result.scene.files[2], (folder / "models/blocks/block.argos").string());
  EXPECT_EQ(count_containing(faults(read_file(folder / "scenes/cycle.argos")), "closes a cycle"),
            1u);
  EXPECT_EQ(count_containing(faults(read_file(folder / "scenes/folder.argos")),
                             "which is not a regular file"),
            1u);
  std::filesystem::remove_all(folder);
}

/// The blocks of XML in the section `Models` of docs/scene-format.md.
std::vector<std::string> documented_files() {
  std::ifstream file(ZIGGURAT_SCENE_FORMAT);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::vector<std::string> blocks;
  const std::size_t end = text.find("\n### ", text.find("\n### Models") + 1);
  for (std::size_t at = text.find("\n### Models"); (at = text.find("```xml\n", at)) < end;) {
    at += 7;
    blocks.push_back(text.substr(at, text.find("```", at) - at));
  }
  return blocks;
}

TEST(Models, TheDocumentedExampleIsValid) {
  const auto blocks = documented_files();
  ASSERT_EQ(blocks.size(), 2u);
  const ReadResult result =
      read_text(blocks[1], "scene.argos", options_with({{"models/block.argos", blocks[0]}}));
  EXPECT_TRUE(result.problems.empty()) << all_problems(result);
  ASSERT_EQ(result.scene.models.size(), 2u);
  ASSERT_EQ(result.scene.entities.size(), 3u);
  EXPECT_EQ(result.scene.controllers.at(*result.scene.entities[1].controller).id, "block");
  EXPECT_EQ(result.scene.controllers.at(*result.scene.entities[2].controller).id, "mine");
  ASSERT_EQ(result.scene.distributions.size(), 1u);
  EXPECT_EQ(result.scene.distributions[0].quantity, 40u);
}

TEST(Text, AThousandRootsAreTooManyFaults) {
  std::string text = "<a/>";
  for (int i = 0; i < 2000; ++i) text += "<b/>";
  EXPECT_EQ(faults(read_text(text, "t")).size(), 1001u);
}

}  // namespace
}  // namespace ziggurat::scene
