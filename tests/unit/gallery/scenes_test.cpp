// SPDX-License-Identifier: MIT
#include "gallery/scenes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.h"

namespace ziggurat::gallery {
namespace {

namespace fs = std::filesystem;

TEST(FirstSentence, EndsAtItsFullStop) {
  EXPECT_EQ(first_sentence("<?xml version=\"1.0\"?>\n<!-- Four robots\n     build. They stop. -->"),
            "Four robots build.");
  EXPECT_EQ(first_sentence("<!-- Heights are 1.5 m (rules.lua) here. More. -->"),
            "Heights are 1.5 m (rules.lua) here.");
  EXPECT_EQ(first_sentence("<!-- Does it stand? It does. -->"), "Does it stand?");
  EXPECT_EQ(first_sentence("<!-- without a full stop -->"), "without a full stop");
  EXPECT_EQ(first_sentence("<!-- cut off"), "cut off");
  EXPECT_EQ(first_sentence("<!----> text."), "");
  EXPECT_EQ(first_sentence("<a/>"), "");
}

TEST(FirstSentence, IsShortAndPrintable) {
  EXPECT_LE(first_sentence("<!--" + std::string(100'000, 'x') + "-->").size(), 300u);
  EXPECT_EQ(first_sentence("<!-- a\x1b[2Jb. -->"), "a\\u001b[2Jb.");
}

TEST(Scenes, AreThoseBelowTheFolder) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  };
  const std::string scene = "<!-- It is one. --><argos-configuration/>";
  write("b.argos", scene);
  write("below/a.argos", "<argos-configuration/>");
  write("1/2/3/deep.argos", scene);
  write("1/2/3/4/too_deep.argos", scene);
  write("model.argos", "<ziggurat-models/>");
  write(".hidden/c.argos", scene);
  write("text.xml", scene);
  fs::create_symlink(folder / "b.argos", folder / "link.argos");
  fs::create_directory_symlink("/", folder / "root");
  const auto scenes = scenes_below(folder.path);
  ASSERT_EQ(scenes.size(), 3u);
  EXPECT_EQ(scenes[0].name, "1/2/3/deep");
  EXPECT_EQ(scenes[1].name, "b");
  EXPECT_EQ(scenes[1].sentence, "It is one.");
  EXPECT_EQ(scenes[2].name, "below/a");
  EXPECT_EQ(scenes[2].sentence, "");
  EXPECT_THROW(scenes_below(folder / "none"), fs::filesystem_error);
}

TEST(Scenes, AreNotMoreThanAReaderCanLookAt) {
  const TemporaryFolder folder;
  for (std::size_t i = 0; i < most_scenes + 3; ++i)
    std::ofstream(folder / (std::to_string(i) + ".argos")) << "<argos-configuration/>";
  EXPECT_EQ(scenes_below(folder.path).size(), most_scenes);
}

}  // namespace
}  // namespace ziggurat::gallery
