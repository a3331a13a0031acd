// SPDX-License-Identifier: MIT
#include "rerun/embedded_scripts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "recording/replay/recording_file.h"
#include "temporary_folder.h"

namespace ziggurat::rerun {
namespace {

namespace fs = std::filesystem;

TEST(EmbeddedScripts, NoNameLeavesTheFolder) {
  const TemporaryFolder folder;
  const fs::path& outside = folder.path;
  replay::EmbeddedFiles files;
  for (const char* name : {"a.lua", "../b.lua", "../../../../../../tmp/c.lua", "/etc/d.lua",
                           "x/../../e.lua", "./y//f.lua"}) {
    files.add(name, "text");
  }
  write_below((outside / "below").string(), files);
  std::set<std::string> written;
  for (const auto& entry : fs::recursive_directory_iterator(outside)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().lexically_relative(outside).string();
    EXPECT_TRUE(path.starts_with("below/")) << path;
    written.insert(entry.path().filename().string());
  }
  EXPECT_EQ(written, (std::set<std::string>{"a.lua", "b.lua", "c.lua", "d.lua", "e.lua", "f.lua"}));
}

/// Script of the only director of such a scene.
std::string script_of_director(const std::string& script, const std::string& scene_path,
                               const std::vector<std::string>& names) {
  replay::EmbeddedFiles files;
  for (const std::string& name : names) files.add(name, "text");
  scene::Director director;
  director.id = "judge";
  director.script = script;
  return script_below("/below", files, {}, scene_path, director);
}

TEST(EmbeddedScripts, AScriptThatIsNamedFromTheRootIsThatOfItsFolder) {
  EXPECT_EQ(
      script_of_director("/a/left/main.lua", "scene.argos", {"left/main.lua", "right/main.lua"}),
      "/below/left/main.lua");
  EXPECT_EQ(script_of_director("/a/left/main.lua", "b/c/scene.argos", {"../left/main.lua"}),
            "/below/_up_/left/main.lua");
  EXPECT_EQ(script_of_director("/a/main.lua", "scene.argos", {"main.lua", "parts/main.lua"}),
            "/below/main.lua");
  EXPECT_EQ(script_of_director("/a/main.lua", "/b/scene.argos", {"/a/main.lua", "/b/main.lua"}),
            "/below/a/main.lua");
  EXPECT_EQ(script_of_director("mine.lua", "scene.argos", {"allowed/mine.lua"}),
            "/below/allowed/mine.lua");
}

TEST(EmbeddedScripts, AScriptOfAnotherFolderIsNotTakenForIt) {
  using Names = std::vector<std::string>;
  for (const Names& names : {Names{"../right/main.lua"},
                             {"right/main.lua"},
                             {"/a/right/main.lua"},
                             {"left/main.lua", "main.lua"},
                             {}}) {
    EXPECT_THROW(script_of_director("/a/left/main.lua", "/a/scenes/scene.argos", names),
                 replay::RecordingError);
  }
  EXPECT_THROW(script_of_director("main.lua", "scene.argos", {"x/main.lua", "y/main.lua"}),
               replay::RecordingError);
}

}  // namespace
}  // namespace ziggurat::rerun
