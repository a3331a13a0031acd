// SPDX-License-Identifier: MIT
// Which files scripts load, as far as their texts say.

#include "processes/required_scripts.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

struct RequiredScripts : ::testing::Test {
  TemporaryFolder folder;
  std::vector<fs::path> left_out;

  /// Files added to main.lua with this text, as paths in the folder. There are a.lua, b.lua and
  /// sub/c.lua.
  std::vector<std::string> added(const std::string& text) {
    fs::create_directory(folder / "sub");
    for (const char* name : {"a.lua", "b.lua", "sub/c.lua", "notes.txt"}) write(name, "");
    write("main.lua", text);
    std::vector<fs::path> scripts{folder / "main.lua"};
    left_out = add_required(scripts);
    std::vector<std::string> names;
    for (const fs::path& path : scripts)
      names.push_back(path.lexically_relative(folder.path).string());
    names.erase(names.begin());
    return names;
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  }
};

using Names = std::vector<std::string>;

TEST_F(RequiredScripts, ThatAreNotThereAreFound) {
  added(
      "local a, b = require 'a', require(\"nothing\")\nlocal s = require('string')\n-- require "
      "'comment'\n"
      "local ok = pcall(require, 'maybe')\nlocal c = require('sub.c') require('parts.' .. a)");
  write("sub/c.lua", "return require('sub.gone')");
  std::vector<std::string> missing;
  for (const MissingModule& each : missing_modules(folder / "main.lua")) {
    missing.push_back(each.script.filename().string() + ":" + std::to_string(each.line) + ":" +
                      each.name);
  }
  EXPECT_EQ(missing, (std::vector<std::string>{"main.lua:1:nothing", "c.lua:1:sub.gone"}));
}

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

TEST_F(RequiredScripts, AllOfTheFolderThatComputedNamesBeginWith) {
  const Names all{"sub/c.lua"};
  EXPECT_EQ(added("require('sub.' .. kind)"), all);
  EXPECT_EQ(added("require(here .. 'sub/' .. kind)"), all);
  EXPECT_EQ(added("dofile('sub/' .. kind .. '.lua')"), all);
  EXPECT_EQ(added("require('none.' .. kind)"), (Names{"a.lua", "b.lua"}));
  fs::create_directory(folder / "sub/robot");
  write("sub/robot/main.lua", "");
  std::vector<fs::path> scripts{folder / "sub/robot/main.lua"};
  write("sub/robot/main.lua", "dofile('../' .. name)");
  EXPECT_TRUE(add_required(scripts).empty());
  EXPECT_EQ(scripts.size(), 1);
}

TEST_F(RequiredScripts, WhatFitsOfAFolderThatIsTooLarge) {
  for (const char* name : {"c.lua", "d.lua", "e.lua", "f.lua"}) {
    write(name, "");
    fs::resize_file(folder / name, std::size_t{4} << 20);
  }
  EXPECT_EQ(added("require(name)"), (Names{"a.lua", "b.lua", "c.lua", "d.lua", "e.lua", "f.lua"}));
  EXPECT_TRUE(left_out.empty());
  write("e2.lua", "-");
  EXPECT_EQ(added("require(name)"), (Names{"a.lua", "b.lua", "c.lua", "d.lua", "e.lua", "e2.lua"}));
  EXPECT_EQ(left_out, std::vector<fs::path>{folder.path});
}

TEST_F(RequiredScripts, WhatFitsOfAFolderWithTooManyFiles) {
  for (int i = 0; i < 1000; ++i) write("part" + std::to_string(i) + ".lua", "");
  EXPECT_EQ(added("require(name)").size(), 999);
  EXPECT_EQ(left_out, std::vector<fs::path>{folder.path});
}

TEST_F(RequiredScripts, WordsAreNoCalls) {
  EXPECT_EQ(added("-- what others require is required here\nlocal required = {}"), Names{});
}

}  // namespace
}  // namespace ziggurat::processes
