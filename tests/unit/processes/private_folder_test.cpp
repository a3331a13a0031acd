// SPDX-License-Identifier: MIT
#include "processes/private_folder.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

TEST(PrivateFolder, IsOursAloneAndGoesWithItsContents) {
  std::string path;
  {
    const PrivateFolder folder;
    path = folder.path();
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
    std::ofstream(path + "/something") << "in it";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(PrivateFolder, RemovesWhatDeadProgramsLeftAndNothingElse) {
  const PrivateFolder parent;
  const char* before = std::getenv("XDG_RUNTIME_DIR");
  const std::string kept = before ? before : "";
  ::setenv("XDG_RUNTIME_DIR", parent.path().c_str(), 1);
  const std::string left = parent.path() + "/ziggurat-aaaaaa";
  const std::string empty = parent.path() + "/ziggurat-bbbbbb";
  const std::string other = parent.path() + "/ziggurat-cccccc";
  for (const auto& each : {left, empty, other}) fs::create_directory(each);
  for (const char* file : {"/lock", "/run"}) std::ofstream(left + file) << "x";
  std::ofstream(other + "/notes") << "of the user";
  const PrivateFolder first;
  const PrivateFolder second;
  before ? ::setenv("XDG_RUNTIME_DIR", kept.c_str(), 1) : ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_FALSE(fs::exists(left));
  EXPECT_FALSE(fs::exists(empty));
  EXPECT_TRUE(fs::exists(other + "/notes"));
  EXPECT_TRUE(fs::exists(first.path())) << "its program runs";
}

TEST(PrivateFolder, IsNotTakenForOneThatWasLeftWhileItIsMade) {
  const PrivateFolder parent;
  constexpr int programs = 8, times = 300;
  std::vector<pid_t> children;
  for (int i = 0; i < programs; ++i) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    ::setenv("XDG_RUNTIME_DIR", parent.path().c_str(), 1);
    bool all_there = true;
    for (int k = 0; k < times; ++k) {
      const PrivateFolder folder;
      for (int look = 0; look < 3; ++look) {
        all_there = all_there && fs::exists(folder.path() + "/lock");
        ::sched_yield();
      }
    }
    ::_exit(all_there ? 0 : 1);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "another program removed the folder";
  }
}

TEST(PrivateFolder, IsShortEvenIfTheRuntimeFolderIsNot) {
  const PrivateFolder parent;
  const auto deep = fs::path(parent.path()) / std::string(120, 'x');
  fs::create_directories(deep);
  const char* before = std::getenv("XDG_RUNTIME_DIR");
  const std::string kept = before ? before : "";
  ::setenv("XDG_RUNTIME_DIR", deep.c_str(), 1);
  const PrivateFolder folder;
  before ? ::setenv("XDG_RUNTIME_DIR", kept.c_str(), 1) : ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_LT(folder.path().size(), 100u);
}

}  // namespace
}  // namespace ziggurat::processes
