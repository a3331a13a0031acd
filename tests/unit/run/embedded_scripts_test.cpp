#include "run/embedded_scripts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "temporary_folder.h"

namespace ziggurat::run {
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

}  // namespace
}  // namespace ziggurat::run
