// SPDX-License-Identifier: MIT
#include "outputs/output_name.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.h"
#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::outputs {
namespace {

namespace fs = std::filesystem;

class OutputNameTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  static std::string complaint(const OutputName& output, const std::vector<TakenFile>& taken = {}) {
    return words_of<text::UsageError>([&] { check_output(output, taken); });
  }
  static bool is_refused(const OutputName& output, std::string_view words) {
    return complaint(output).find(words) != std::string::npos;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(OutputNameTest, TheEndingIsThatOfTheContent) {
  EXPECT_EQ(complaint({"--csv", path("x.csv"), {".csv"}}), "");
  EXPECT_EQ(complaint({"--report", path("x.svg"), {".json", ".svg"}}), "");
  EXPECT_EQ(complaint({"--hashes", path("x"), {}}), "");
  EXPECT_EQ(complaint({"--csv", "x.txt", {".csv", ".svg"}}),
            "--csv is 'x.txt'; its name must end with .csv or .svg, because that is the format of "
            "its content");
  EXPECT_NE(complaint({"--csv", path("x"), {".csv"}}), "") << "none is none of them";
}

TEST_F(OutputNameTest, StreamsNeedNone) {
  for (const char* name : {"-", "/dev/null", "/dev/full", "/dev/stdout", "/dev/fd/1"}) {
    EXPECT_EQ(complaint({"--csv", name, {".csv"}}), "") << name;
  }
}

TEST_F(OutputNameTest, ATakenFileIsRefusedByAllOfItsNames) {
  const std::vector<TakenFile> taken{{write("in", "text"), "the file that is read"}};
  fs::create_symlink("in", path("soft.csv"));
  fs::create_hard_link(path("in"), path("hard.csv"));
  for (const char* name : {"soft.csv", "hard.csv", "./hard.csv"}) {
    EXPECT_EQ(complaint({"--csv", path(name), {".csv"}}, taken),
              "--csv is '" + path(name) + "', the file that is read; name another file");
  }
  EXPECT_EQ(complaint({"--csv", path("new.csv"), {".csv"}}, taken), "");
}

TEST_F(OutputNameTest, FilesThatDoNotExistYetAreOneByTheirPath) {
  EXPECT_TRUE(is_one_file(path("new.csv"), path("./new.csv")));
  EXPECT_TRUE(is_one_file("new.csv", "./new.csv"));
  EXPECT_FALSE(is_one_file(path("new.csv"), path("other.csv")));
  EXPECT_FALSE(is_one_file("/dev/null", "/dev/null")) << "it has place for several";
}

TEST_F(OutputNameTest, WhatZigguratReadsIsNotReplacedByAnotherKind) {
  write("s.argos", "");
  fs::create_symlink("s.argos", path("s.csv"));
  write("p.lua", "");
  fs::create_symlink("p.lua", path("p.csv"));
  EXPECT_TRUE(is_refused({"--csv", path("s.csv"), {".csv"}},
                         "a scene, which it would replace; name another file"));
  EXPECT_TRUE(is_refused({"--csv", path("p.csv"), {".csv"}}, "a Lua script, which"));
  EXPECT_TRUE(is_refused({"--hashes", path("p.lua"), {}}, "a Lua script, which"));
}

TEST_F(OutputNameTest, OlderOutputsAreReplaced) {
  for (const char* name : {"run.mcap", "x.csv", "x.svg"}) write(name, "");
  EXPECT_EQ(complaint({"--record", path("run.mcap"), {".mcap"}}), "");
  EXPECT_EQ(complaint({"--csv", path("x.csv"), {".csv"}}), "");
  EXPECT_EQ(complaint({"--plot", path("x.svg"), {".svg"}}), "");
}

}  // namespace
}  // namespace ziggurat::outputs
