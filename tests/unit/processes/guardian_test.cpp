// SPDX-License-Identifier: MIT
#include "processes/guardian.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "processes/child_process.h"
#include "processes/private_folder.h"
#include "waiting.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

/// Runs this in a process of its own, which it must kill before it returns.
template <class Work>
void in_another_process(Work work) {
  const pid_t process = ::fork();
  if (process == 0) {
    work();
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(Guardian, EndsGroupsAndRemovesFilesOfAKilledProcess) {
  const PrivateFolder folder;
  const std::string in = folder.path();
  in_another_process([&] {
    const Guardian guardian;
    fs::create_directory(in + "/private");
    std::ofstream(in + "/private/file") << "x";
    guardian.remove_folder(in + "/private");
    // The child of a child, which a signal at the parent's death does not reach.
    const ChildProcess child(
        {{"/bin/sh", "-c", "sh -c 'echo $$ >" + in + "/id; exec sleep 1000' & wait"}, {}},
        &guardian);
    comes_true([&] { return fs::exists(in + "/id") && fs::file_size(in + "/id") > 0; });
    ::kill(::getpid(), SIGKILL);
  });
  pid_t grandchild = 0;
  std::ifstream(in + "/id") >> grandchild;
  ASSERT_GT(grandchild, 0);
  // Gone, or ended and not yet collected by its new parent.
  EXPECT_TRUE(comes_true([&] {
    std::string state;
    std::ifstream status("/proc/" + std::to_string(grandchild) + "/stat");
    status >> state >> state >> state;
    return !status || state == "Z";
  }));
  EXPECT_TRUE(comes_true([&] { return !fs::exists(in + "/private"); }));
}

/// A socket that listens at this path.
int listen(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int made = ::socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_EQ(::bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(made, 1), 0);
  return made;
}

TEST(Guardian, RemovesADeadSocketAndNoOther) {
  const PrivateFolder folder;
  const int live = listen(folder.path() + "/live");
  std::ofstream(folder.path() + "/file") << "of the user";
  in_another_process([&] {
    const Guardian guardian;
    for (const char* name : {"/missing", "/live", "/file", "/dead"})
      guardian.remove_dead_socket(folder.path() + name);
    listen(folder.path() + "/dead");
    ::kill(::getpid(), SIGKILL);
  });
  EXPECT_TRUE(comes_true([&] { return !fs::exists(folder.path() + "/dead"); }));
  EXPECT_TRUE(fs::exists(folder.path() + "/live"));
  EXPECT_TRUE(fs::exists(folder.path() + "/file"));
  ::close(live);
}

}  // namespace
}  // namespace ziggurat::processes
