// SPDX-License-Identifier: MIT
// Faults of a file below the level of elements: missing, too large, not XML.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "scene_text.h"
#include "temporary_folder.h"

namespace ziggurat::scene {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Folder : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
    return path / name;
  }
  TemporaryFolder folder;
  std::filesystem::path path = folder.path;
};

TEST_F(Folder, AValidFileIsRead) {
  const ReadResult result = read_file(write("valid.argos", SceneText{}.str()));
  EXPECT_TRUE(result.problems.empty()) << all_problems(result);
  EXPECT_EQ(result.scene.files.at(0), (path / "valid.argos").string());
  EXPECT_EQ(result.scene.experiment.ticks_per_second, 10u);
}

TEST_F(Folder, MissingFilesAndOtherKindsOfFilesAreFaults) {
  EXPECT_TRUE(
      contains(only_fault(read_file(path / "none.argos")), "does not exist; check its path"));
  const auto valid = write("valid.argos", SceneText{}.str());
  EXPECT_TRUE(
      contains(only_fault(read_file(path / "valid")), "does not exist; write " + valid.string()));
  EXPECT_TRUE(contains(only_fault(read_file(path)), "is a folder"));
  ASSERT_EQ(::mkfifo((path / "fifo").c_str(), 0600), 0);
  EXPECT_TRUE(contains(only_fault(read_file(path / "fifo")), "not a regular file"));
  EXPECT_TRUE(contains(only_fault(read_file("/dev/zero")), "not a regular file"));
}

TEST(Encoding, AnotherThanUtf8IsAFault) {
  const auto read_as = [](const std::string& encoding) {
    return read_text("<?xml version=\"1.0\" encoding=" + encoding + "?>\n" + SceneText{}.str(),
                     "scene.argos");
  };
  for (const char* encoding : {"\"UTF-8\"", "'utf-8'", "\"US-ASCII\"", "\"ISO-8859-1\"", "\"\""}) {
    EXPECT_TRUE(read_as(encoding).problems.empty()) << encoding << all_problems(read_as(encoding));
  }
  for (const char* encoding : {"\"EBCDIC\"", "\"UTF-16\"", "'Shift_JIS'"}) {
    EXPECT_TRUE(contains(only_fault(read_as(encoding)), "is not read; save the file in UTF-8"))
        << encoding;
  }
  EXPECT_TRUE(contains(only_fault(read_as("\"EBCDIC\"")), "encoding=\"EBCDIC\""));
}

TEST(Root, ThatIsNearlyTheUsualOneIsDoubted) {
  for (const std::string name :
       {"argos-config", "argos_configuration", "argos-configuraton", "Argos-configuration"}) {
    std::string text = SceneText{}.str();
    for (auto at = text.find("argos-configuration"); at != std::string::npos;
         at = text.find("argos-configuration", at + name.size())) {
      text.replace(at, 19, name);
    }
    const ReadResult result = read_text(text, "scene.argos");
    EXPECT_TRUE(result.ok());
    EXPECT_TRUE(
        contains(all_problems(result), "<" + name + ">; did you mean <argos-configuration>?"))
        << all_problems(result);
  }
}

TEST_F(Folder, EmptyAndBinaryFilesAreFaults) {
  EXPECT_TRUE(contains(only_fault(read_file(write("empty", ""))), "is empty"));
  EXPECT_TRUE(contains(only_fault(read_file(write("white", " \n\t\n"))), "is empty"));
  EXPECT_TRUE(contains(only_fault(read_file(write("binary", std::string("\x7f"
                                                                        "ELF\0\1",
                                                                        6)))),
                       "binary:1:5: this is binary data"));
  EXPECT_TRUE(contains(only_fault(read_file(write("latin", "<a>\n<b id=\"caf\xe9\"/></a>"))),
                       "latin:2:11: this is not UTF-8"));
}

TEST_F(Folder, TooLargeIsRefusedBeforeItIsRead) {
  const std::filesystem::path file = write("large", SceneText{}.str());
  ReadOptions options;
  options.max_size = 100;
  EXPECT_TRUE(contains(only_fault(read_file(file, options)), "larger than 100 bytes"));
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);  // a sparse terabyte
  EXPECT_TRUE(contains(only_fault(read_file(file)), "larger than 67108864 bytes"));
}

TEST(Text, SizeAtTheLimitIsRead) {
  const std::string text = SceneText{}.str();
  ReadOptions options;
  options.max_size = text.size();
  EXPECT_TRUE(read_text(text, "t", options).ok());
  --options.max_size;
  EXPECT_FALSE(read_text(text, "t", options).ok());
}

TEST(Text, TruncatedAnywhereIsAFaultWithLineAndColumn) {
  const std::string text = SceneText{}.str();
  const std::size_t end = text.rfind("</argos-configuration>");
  for (std::size_t size = 1; size < end + 20; ++size) {
    const ReadResult result = read_text(text.substr(0, size), "t");
    const std::string fault = only_fault(result);
    EXPECT_TRUE(contains(fault, "malformed XML")) << size << ": " << fault;
    EXPECT_GE(result.problems[0].where.line, 1u);
    EXPECT_GE(result.problems[0].where.column, 1u);
  }
  EXPECT_EQ(only_fault(read_text("<a>\n  <b>\n", "t")),
            "t:2:6: malformed XML: the file ends too early; close every element that was opened, "
            "first <b> of line 2");
}

TEST(Text, MalformedXmlIsAFaultAtItsPlace) {
  EXPECT_TRUE(contains(only_fault(read_text("<a>\n  <b></c>\n</a>", "t")),
                       "t:2:6: malformed XML: </c> does not close <b> of line 2; write </b>"));
  EXPECT_TRUE(contains(only_fault(read_text("hello", "t")), "t: this is no XML"));
  EXPECT_TRUE(contains(only_fault(read_text("<a b=c/>", "t")), "t:1:6: malformed XML"));
}

TEST(Text, LinesEndWithLineFeedReturnOrBoth) {
  for (const char* text :
       {"<a>\n\n  <b></c>\n</a>", "<a>\r\r  <b></c>\r</a>", "<a>\r\n\r\n  <b></c>\r\n</a>"}) {
    EXPECT_TRUE(contains(only_fault(read_text(text, "t")),
                         "t:3:6: malformed XML: </c> does not close <b> of line 3"));
  }
}

TEST(Text, WhatOtherParsersRefuseIsTold) {
  SceneText text;
  text.arena = arena_with(R"(<box id="a < b" size="1,1,1" movable="false"><body/></box>)");
  EXPECT_TRUE(contains(only_fault(text.read()), "malformed XML: < inside a value; write &lt;"))
      << all_problems(text.read());
  text.arena = arena_with(
      R"(<!-- a < b > c, "d' --><box id="a &lt; b > c" size="1,1,1" movable="false"><body/></box>)");
  EXPECT_TRUE(text.read().problems.empty()) << all_problems(text.read());
  for (const char* comment : {"<!-- a -- b -->", "<!-- a --->", "<!---------->"}) {
    text.arena = arena_with(comment);
    const ReadResult result = text.read();
    ASSERT_TRUE(result.ok()) << comment;
    ASSERT_EQ(result.problems.size(), 1u) << comment << all_problems(result);
    EXPECT_TRUE(contains(result.problems[0].text, "-- inside a comment")) << all_problems(result);
  }
  text.arena = arena_with("<!----><!-- - - -->");
  EXPECT_TRUE(text.read().problems.empty()) << all_problems(text.read());
}

TEST_F(Folder, TextOutsideOfTheRootElementIsTold) {
  const std::string scene = SceneText{}.str();
  EXPECT_TRUE(read_file(write("good.argos", "\xEF\xBB\xBF" + scene + "\n")).problems.empty());
  for (const std::string& text : {"scene " + scene, "<!-- a -->\n" + scene + "\n x"}) {
    const ReadResult result = read_file(write("told.argos", text));
    EXPECT_TRUE(result.ok()) << all_problems(result);
    ASSERT_EQ(result.problems.size(), 1u) << all_problems(result);
    EXPECT_TRUE(contains(result.problems[0].text, "outside of the root element"))
        << all_problems(result);
  }
}

/// A scene with something of everything, whose words are replaced one by one.
constexpr std::string_view sample = R"(<argos-configuration>
<parameters gain="0.5"/>
<framework><experiment length="5" ticks_per_second="10" random_seed="1"/></framework>
<controllers><lua_controller id="push">
<actuators><joints implementation="default"><joint id="rail" mode="velocity" max_impulse="${gain}"/></joints></actuators>
<sensors><joints implementation="default"><joint id="rail" mode="position"/></joints></sensors>
<params script="slider.lua"/></lua_controller></controllers>
<arena size="2,2,1" center="0,0,0.5"> text
<prototype id="slider" movable="false"><body position="0,0,0" orientation="0,0,0"/><controller config="push"/>
<links ref="base"><link id="base" geometry="box" size="0.4,0.1,0.1" mass="1" position="0,0,0" orientation="0,0,0"/>
<link id="sled" geometry="box" size="0.1,0.1,0.05" mass="0.2" position="0,0,0.1" orientation="0,0,0"/></links>
<joints><joint id="rail" type="prismatic" axis="1,0,0" limit="-0.2:0.2">
<parent link="base" position="0,0,0.1" orientation="0,0,0"/><child link="sled" position="0,0,0" orientation="0,0,0"/></joint></joints>
<devices><leds medium="leds"><led anchor="sled" offset="0,0,0" color="red"/></leds></devices></prototype>
<distribute><position method="uniform" min="1,1,0" max="2,2,0"/><orientation method="constant" values="0,0,0"/>
<entity quantity="2" max_trials="10"><box id="b" size="0.1,0.1,0.1" movable="false"><body/></box></entity></distribute></arena>
<physics_engines><dynamics3d id="dyn" iterations="10"><floor/><gravity g="9.8"/></dynamics3d></physics_engines>
<media><led id="leds"/></media>
</argos-configuration>)";

TEST(Text, NoMessageQuotesMoreThanAPartOfALongText) {
  constexpr std::size_t most = 1000;  // of a message [bytes]
  const std::string word(5000, 'x');
  std::string words, numbers, condition = "${";
  for (int i = 0; i < 1000; ++i) words += "a b ", numbers += "1, ", condition += "a ";
  const ReadOptions options{.variation = {{{"//@g", words}, {"arena/@" + word, word}},
                                          {{"gain", numbers}, {"none", words}}}};
  std::size_t tried = 0;
  const auto check = [&](const std::string& text) {
    for (const ReadOptions& each : {ReadOptions{}, options}) {
      for (const Problem& problem : read_text(text, "t", each).problems) {
        ASSERT_LE(text_of(problem).size(), most) << text << '\n' << text_of(problem);
      }
    }
    ++tried;
  };
  for (std::size_t begin = 0; begin < sample.size();) {
    constexpr std::string_view ends = "<>/=\" \n";
    const std::size_t end = std::min(sample.find_first_of(ends, begin + 1), sample.size());
    for (const std::string& longer :
         {word, words, numbers, condition + "}", "\"" + word, "=" + word, word + " " + word}) {
      check(std::string(sample.substr(0, begin + 1)) + longer + std::string(sample.substr(end)));
    }
    begin = end;
  }
  EXPECT_GT(tried, 1000u);
  const std::string megabytes(3'000'000, 'n');
  check("<argos-configuration " + megabytes + "=\"1\"/>");
  check("<argos-configuration><" + megabytes + "/></argos-configuration>");
}

TEST(Text, AnXmlDeclarationBehindTheBeginningIsTold) {
  constexpr std::string_view declaration = "<?xml version=\"1.0\" ?>";
  const std::string scene = SceneText{}.str(), declared = std::string(declaration) + "\n" + scene;
  for (const std::string& good :
       {declared, "\xEF\xBB\xBF" + declared, "<?xml-stylesheet href='a'?>\n<?xmlx?>" + scene}) {
    EXPECT_TRUE(read_text(good, "t").problems.empty()) << all_problems(read_text(good, "t"));
  }
  const auto told = [](const std::string& text) {
    const ReadResult result = read_text(text, "t");
    EXPECT_TRUE(result.ok()) << all_problems(result);
    return result.problems.size() == 1 ? to_string(result.problems[0]) : all_problems(result);
  };
  const std::string text = "<?xml … ?> behind the beginning of the file";
  EXPECT_TRUE(contains(told("\n" + declared), "t:2:1: " + text)) << told("\n" + declared);
  EXPECT_TRUE(contains(told("<!-- a -->\n\n" + declared), "t:3:1: " + text));
  EXPECT_TRUE(contains(told(declared + "<?XML?>"), ": " + text));
  const std::string type =
      "<!DOCTYPE argos-configuration [<!-- > ' --><!ELEMENT a (#PCDATA)><?b ' ?>] >\n";
  EXPECT_TRUE(contains(all_problems(read_text(type + declared, "t")), "t:2:1: " + text))
      << all_problems(read_text(type + declared, "t"));
  SceneText inside;
  inside.arena = arena_with(std::string(declaration));
  EXPECT_TRUE(contains(told(inside.str()), "t:4:")) << told(inside.str());
}

TEST(Text, AnEntityBombIsHarmlessAndReported) {
  std::string text = "<?xml version=\"1.0\"?>\n<!DOCTYPE bomb [\n<!ENTITY lol0 \"lol\">\n";
  for (int i = 1; i < 10; ++i) {
    text += "<!ENTITY lol" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) text += "&lol" + std::to_string(i - 1) + ";";
    text += "\">\n";
  }
  SceneText scene;
  scene.arena = arena_with("<box id=\"&lol9;\" size=\"1,1,1\" movable=\"false\"><body/></box>");
  const ReadResult result = read_text(text + "]>\n" + scene.str(), "t");
  const auto texts = faults(result);
  ASSERT_EQ(texts.size(), 2u) << all_problems(result);
  EXPECT_TRUE(contains(texts[0], "t:2:11: the document type declares entities"));
  EXPECT_TRUE(contains(texts[1], "reference \"&lol9;\", which stands for no character"));
}

TEST(Text, CharacterReferencesAreReplaced) {
  SceneText text;
  text.arena =
      arena_with("<box id=\"a&#98;&amp;&#x63;\" size=\"1,1,1\" movable=\"false\"><body/></box>");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities.at(0).id, "ab&c");
  for (const char* reference : {"&#0;", "&#xD800;", "&#1;", "&#x110000;", "& b", "&nbsp;"}) {
    text.arena = arena_with("<box id=\"a" + std::string(reference) +
                            "\" size=\"1,1,1\" movable=\"false\"><body/></box>");
    EXPECT_FALSE(text.read().ok()) << reference;
  }
}

TEST(Text, RepeatedAttributesAndSecondRootsAreFaults) {
  SceneText text;
  text.arena = R"(<arena size="1,1,1" size="2,2,2"/>)";
  EXPECT_TRUE(contains(only_fault(text.read()),
                       "4:21: malformed XML: <arena> has the attribute "
                       "\"size\" twice"));
  EXPECT_TRUE(contains(only_fault(read_text(SceneText{}.str() + "<more/>", "t")),
                       "a second root element, <more>"));
}

TEST(Text, ByteOrderMarkAndUtf8AreRead) {
  EXPECT_TRUE(read_text("\xef\xbb\xbf" + SceneText{}.str(), "t").problems.empty());
  SceneText text;
  text.arena = arena_with(R"(<box id="café" size="1,1,1" movable="false"><body/></box>)");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(result.scene.entities.at(0).id, "café");
}

TEST(Text, StrayTextIsNoticed) {
  SceneText text;
  text.arena = arena_with("oops");
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(count_containing(notices(result), "the text \"oops\" in <arena> has no effect"), 1u);
}

TEST(Text, TheNumberOfFaultsIsLimited) {
  std::string boxes;
  for (int i = 0; i < 100000; ++i) boxes += "<box/>";
  SceneText text;
  text.arena = arena_with(boxes);
  const auto texts = faults(text.read());
  EXPECT_EQ(texts.size(), 1001u);
  EXPECT_EQ(count_containing(texts, "the rest of the file was not read"), 1u);
}

TEST(Text, AThousandRootsAreTooManyFaults) {
  std::string text = "<a/>";
  for (int i = 0; i < 2000; ++i) text += "<b/>";
  EXPECT_EQ(faults(read_text(text, "t")).size(), 1001u);
}

TEST(Text, DepthAndNumberOfElementsAreLimited) {
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_FALSE(read_text(deep, "t").ok());
  for (int i = 0; i < 200000; ++i) deep += "</a>";
  EXPECT_FALSE(read_text(deep, "t").ok());
  EXPECT_TRUE(contains(only_fault(read_text(std::string(9'000'000, '<'), "t")),
                       "more than 2097152 elements"));
}

TEST(Lenient, UnknownAttributesAreNoticesAndElementsStayFaults) {
  SceneText text;
  text.arena = R"(<arena size="1,1,1" colour="red"/>)";
  text.engines = R"(<physics_engines><dynamics3d id="d"><blob/></dynamics3d></physics_engines>)";
  EXPECT_EQ(faults(text.read()).size(), 2u);
  ReadOptions options;
  options.lenient = true;
  const ReadResult result = text.read(options);
  EXPECT_TRUE(contains(only_fault(result), "unknown element <blob>"));
  EXPECT_EQ(count_containing(notices(result), "4:21: unknown attribute \"colour\" of <arena>"), 1u);
}

TEST(Lenient, LeavesOutDevicesAndRobotsOfPlugIns) {
  SceneText text;
  text.controllers =
      R"(<controllers><my_controller id="c"><actuators><jump implementation="default"/></actuators>)"
      R"(<sensors><drone_nose implementation="default"/></sensors></my_controller></controllers>)";
  text.arena = arena_with(
      R"(<thymio id="t"/><ramp id="r"/><foot-bot id="f"><body/><controller config="c"/></foot-bot>)");
  text.media = "<media><ether id=\"e\"/></media>";
  EXPECT_EQ(faults(text.read()).size(), 5u) << all_problems(text.read());
  ReadOptions options;
  options.lenient = true;
  const ReadResult result = text.read(options);
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "is not known here, and is left out"), 5u);
  EXPECT_EQ(result.scene.entities.size(), 1u);
}

TEST(Problems, AreInDocumentOrder) {
  SceneText text;
  text.framework = "<framework><experiment ticks_per_second=\"0\"/></framework>";
  text.arena = arena_with("<box/>");
  text.engines = "<physics_engines><dynamics3d/></physics_engines>";
  const ReadResult result = text.read();
  for (std::size_t i = 1; i < result.problems.size(); ++i) {
    EXPECT_LE(result.problems[i - 1].where.line, result.problems[i].where.line);
  }
  EXPECT_EQ(result.problems.front().where.line, 2u);
  EXPECT_EQ(result.problems.back().where.line, 5u);
}

TEST(SceneErrorText, ContainsAllFaultsAndNoNotices) {
  const SceneError error({{Problem::Severity::notice, "f", {0, 1, 1}, "n"},
                          {Problem::Severity::fault, "f", {0, 2, 3}, "one"},
                          {Problem::Severity::fault, "g", {}, "two"}});
  EXPECT_STREQ(error.what(), "f:2:3: one\ng: two");
  EXPECT_EQ(error.problems().size(), 3u);
}

}  // namespace
}  // namespace ziggurat::scene
