#include "processes/guardian.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

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

TEST(Guardian, DoesNothingAfterAnOrderlyEnd) {
  const PrivateFolder folder;
  fs::create_directory(folder.path() + "/private");
  {
    const Guardian guardian;
    guardian.remove_folder(folder.path() + "/private");
  }
  EXPECT_TRUE(fs::exists(folder.path() + "/private"));
}

TEST(Guardian, WorksAtOnceIfAsked) {
  const PrivateFolder folder;
  fs::create_directory(folder.path() + "/private");
  Guardian guardian;
  guardian.remove_folder(folder.path() + "/private");
  guardian.end_now();
  EXPECT_TRUE(comes_true([&] { return !fs::exists(folder.path() + "/private"); }));
}

TEST(Guardian, RemovesWhatIsMadeBetweenItsWorkAndTheEnd) {
  const PrivateFolder folder;
  const std::string in = folder.path() + "/private";
  in_another_process([&] {
    Guardian guardian;
    guardian.remove_folder(in);
    std::atomic<int> made = 0;
    std::thread worker([&] {  // as one that starts processes
      for (;; ++made) {
        std::error_code ignored;
        fs::create_directory(in, ignored);
        std::ofstream(in + "/robots-" + std::to_string(made)) << "x";
      }
    });
    comes_true([&] { return made >= 100; });
    guardian.end_now();
    const int before = made;
    comes_true([&] { return made >= before + 100; });
    ::kill(::getpid(), SIGKILL);
  });
  EXPECT_TRUE(comes_true([&] { return !fs::exists(in); }));
}

TEST(Guardian, OneThatIsSlowIsNotCutShort) {
  const PrivateFolder folder;
  fs::create_directory(folder.path() + "/private");
  in_another_process([&] {
    Guardian guardian;
    guardian.remove_folder(folder.path() + "/private");
    const std::string me = std::to_string(::getpid());
    pid_t process = 0;
    std::ifstream("/proc/" + me + "/task/" + me + "/children") >> process;
    if (process == 0 || ::kill(process, SIGSTOP) != 0) return;
    guardian.end_now();
    ::kill(::getpid(), SIGKILL);
  });
  EXPECT_TRUE(comes_true([&] { return !fs::exists(folder.path() + "/private"); }));
}

TEST(Guardian, OneThatIsKilledHasASecondThatTakesItsPlace) {
  const PrivateFolder folder;
  const std::string in = folder.path();
  for (const char* name : {"before", "between", "after"}) fs::create_directory(in + "/" + name);
  in_another_process([&] {
    const Guardian guardian;
    const auto child_of = [](pid_t parent) {
      const std::string id = std::to_string(parent);
      std::ifstream children("/proc/" + id + "/task/" + id + "/children");
      pid_t child = 0;
      children >> child;
      return child;
    };
    guardian.remove_folder(in + "/before");
    const pid_t first = child_of(::getpid());
    comes_true([&] { return child_of(first) != 0; });
    const pid_t second = child_of(first);
    ::kill(first, SIGKILL);
    guardian.remove_folder(in + "/between");
    comes_true([&] { return child_of(second) != 0; });
    guardian.remove_folder(in + "/after");
    ::kill(::getpid(), SIGKILL);
  });
  for (const char* name : {"before", "between", "after"}) {
    EXPECT_TRUE(comes_true([&] { return !fs::exists(in + "/" + name); })) << name;
  }
}

/// A socket that listens at this path, or, if it begins with NUL, under this name.
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
    for (const char* name : {"/missing", "/live", "/file", "/dead"}) guardian.remove_dead_socket(folder.path() + name, "a lock");
    listen(folder.path() + "/dead");
    ::kill(::getpid(), SIGKILL);
  });
  EXPECT_TRUE(comes_true([&] { return !fs::exists(folder.path() + "/dead"); }));
  EXPECT_TRUE(fs::exists(folder.path() + "/live"));
  EXPECT_TRUE(fs::exists(folder.path() + "/file"));
  ::close(live);
}

TEST(Guardian, RemovesNoSocketWhileAServerBeginsAtItsPath) {
  const PrivateFolder folder;
  const std::string dead = folder.path() + "/dead", lock = folder.path() + "/lock", over = folder.path() + "/over";
  const int begins = listen('\0' + lock);
  in_another_process([&] {
    const Guardian guardian;
    guardian.remove_dead_socket(dead, lock);
    guardian.remove_folder(over);
    fs::create_directory(over);
    listen(dead);
    ::kill(::getpid(), SIGKILL);
  });
  EXPECT_TRUE(comes_true([&] { return !fs::exists(over); }));  // which is the last that it does
  EXPECT_TRUE(fs::exists(dead));
  ::close(begins);
}

}  // namespace
}  // namespace ziggurat::processes
