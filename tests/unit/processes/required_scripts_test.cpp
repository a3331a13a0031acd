// Which files scripts load, as far as their texts say.

#include "processes/required_scripts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

struct RequiredScripts : ::testing::Test {
  TemporaryFolder folder;

  /// What is added to main.lua with this text, as paths in the folder. There are a.lua, b.lua and sub/c.lua.
  std::vector<std::string> added(const std::string& text) {
    fs::create_directory(folder / "sub");
    for (const char* name : {"a.lua", "b.lua", "sub/c.lua", "notes.txt"}) write(name, "");
    write("main.lua", text);
    std::vector<fs::path> scripts{folder / "main.lua"};
    add_required(scripts);
    std::vector<std::string> names;
    for (const fs::path& path : scripts) names.push_back(path.lexically_relative(folder.path).string());
    names.erase(names.begin());
    return names;
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
};

using Names = std::vector<std::string>;

TEST_F(RequiredScripts, PlainNames) {
  EXPECT_EQ(added("local a = require 'a'"), Names{"a.lua"});
  EXPECT_EQ(added("local c = require(\"sub.c\")"), Names{"sub/c.lua"});
  EXPECT_EQ(added("dofile('b.lua')"), Names{"b.lua"});
  EXPECT_EQ(added("require(here .. \"a\")"), Names{"a.lua"});
  EXPECT_EQ(added("require 'none'"), Names{});
}

TEST_F(RequiredScripts, AllOfTheFolderIfANameIsComputed) {
  const Names all{"a.lua", "b.lua"};
  EXPECT_EQ(added("return require(name)"), all);
  EXPECT_EQ(added("local ok, a = pcall(require, name)"), all);
  EXPECT_EQ(added("require('a' .. number)"), all);
  EXPECT_EQ(added("dofile(folder .. part .. '.lua')"), all);
}

TEST_F(RequiredScripts, WordsAreNoCalls) {
  EXPECT_EQ(added("-- what others require is required here\nlocal required = {}"), Names{});
}

}  // namespace
}  // namespace ziggurat::processes
