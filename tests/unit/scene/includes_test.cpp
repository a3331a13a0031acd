// SPDX-License-Identifier: MIT
// Files that a scene includes.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model_files.h"
#include "temporary_folder.h"

namespace ziggurat::scene {
namespace {

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
  const TemporaryFolder folder;
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
                             "which is a folder; write the path of a file"),
            1u);
}

}  // namespace
}  // namespace ziggurat::scene
