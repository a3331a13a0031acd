// SPDX-License-Identifier: MIT
// Faults of models and of the files that contain them, each at its place.

#include <gtest/gtest.h>

#include "model_files.h"

namespace ziggurat::scene {
namespace {

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
    {"MisspeltForAController",
     "<prototype id=\"a\" model=\"blok\"><body/><controller config=\"blink\"/></prototype>",
     include_block,
     "test.argos:5:26: model=\"blok\" of <prototype> names no model; did you mean \"block\"?"},
    {"OtherElement", "<box id=\"a\" model=\"block\"><body/></box>", include_block,
     "test.argos:5:20: model=\"block\" of <box> is a <prototype>, defined at "
     "parts/block.argos:6:1; write <prototype model=\"block\" …>"},
    {"Links", "<prototype id=\"a\" model=\"block\"><body/>\n<links ref=\"l\"/></prototype>",
     include_block,
     "test.argos:6:1: <links> can't stand in this <prototype>: the model has it, at "
     "parts/block.argos:6:1; with a model write only id, model, movable, <body> and <controller> "
     "(in "
     "prototype \"a\" of model \"block\")"},
    {"Devices", "<prototype id=\"a\" model=\"block\"><body/><devices/></prototype>", include_block,
     "test.argos:5:40: <devices> can't stand in this <prototype>"},
    {"Attribute", "<box id=\"a\" model=\"crate\" friction=\"1\"><body/></box>",
     "<models><box id=\"crate\" size=\"1,1,1\" movable=\"true\" mass=\"1\"/></models>",
     "test.argos:5:27: the attribute friction=\"1\" can't stand in this <box>: the model has it"},
    {"AttributeOfLinks", "<prototype id=\"a\" model=\"block\" mass=\"3\"><body/></prototype>",
     include_block,
     "test.argos:5:33: <prototype> has an unknown attribute mass=\"3\"; a <link> has it"},
    {"NoBody", "<prototype id=\"a\" model=\"block\"/>", include_block,
     "test.argos:5:1: <prototype> lacks the element <body>"},
    {"EmptyName", "<prototype id=\"a\" model=\"\"><body/></prototype>", include_block,
     "test.argos:5:26: model=\"\" of <prototype> "},
    {"UnknownController",
     "<prototype id=\"a\" model=\"block\"><body/><controller config=\"blnk\"/></prototype>",
     include_block,
     "test.argos:5:60: config=\"blnk\" of <controller> names no controller; did you mean"},
    {"SecondModel", "", "<include file=\"parts/block.argos\"/><include file=\"again\"/>",
     "again:1:27: id=\"block\" of <prototype> is the id of an earlier model at "
     "parts/block.argos:6:1"},
    {"SecondController", "", "<include file=\"other\"/>",
     "other:2:26: id=\"other\" of <external_controller> is the id of an earlier controller at "
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
     "arena:2:1: <arena> can't stand in this <m>: a file that is included may have <include>, "
     "<models>"},
    {"Malformed", "", "<include file=\"bad\"/>",
     "bad:2:1: malformed XML: <b> is not closed before </a>"},
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

}  // namespace
}  // namespace ziggurat::scene
