// SPDX-License-Identifier: MIT
#include "processes/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <system_error>

#include "posix/descriptor.h"
#include "processes/private_folder.h"
#include "waiting.h"

namespace ziggurat::processes {
namespace {

Program shell(const std::string& command) { return {{"/bin/sh", "-c", command}, {}}; }

std::string end_of(const std::string& command) {
  ChildProcess child(shell(command));
  EXPECT_TRUE(comes_true([&] { return child.poll(); }));
  return child.how_it_ended();
}

TEST(ChildProcess, SaysHowItEnded) {
  EXPECT_EQ(end_of("exit 0"), "ended with exit code 0");
  EXPECT_EQ(end_of("exit 7"), "ended with exit code 7");
  EXPECT_EQ(end_of("kill -9 $$"), "was killed by signal 9 (Killed)");
}

TEST(ChildProcess, HasWhatTheProgramAsksForInItsEnvironment) {
  ChildProcess child({{"/bin/sh", "-c", "test \"$A\" = x && test -n \"$PATH\""}, {{"A", "x"}}});
  EXPECT_TRUE(comes_true([&] { return child.poll(); }));
  EXPECT_EQ(child.how_it_ended(), "ended with exit code 0");
}

TEST(ChildProcess, ReadsNothingFromOurStdin) {
  EXPECT_EQ(end_of("test -z \"$(cat)\""), "ended with exit code 0");
}

TEST(ChildProcess, ThatDoesNotExistIsAnError) {
  EXPECT_THROW(ChildProcess({{"/no/such/program"}, {}}), std::system_error);
}

TEST(ChildProcess, TakesItsWholeGroupWithItWhenDropped) {
  const PrivateFolder folder;
  const auto ready = folder.path() + "/ready", held = folder.path() + "/held";
  ASSERT_EQ(::mkfifo(held.c_str(), 0600), 0);
  const posix::Descriptor reader(::open(held.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  {
    ChildProcess child(shell("exec 9> " + held + "; sleep 1000 & touch " + ready + "; wait"));
    ASSERT_TRUE(comes_true([&] { return std::filesystem::exists(ready); }));
  }
  char byte;
  EXPECT_TRUE(comes_true([&] { return ::read(reader.number(), &byte, 1) == 0; }))
      << "none of the group has it open";
}

TEST(ChildProcess, StubbornOnesAreKilledInTheEnd) {
  const PrivateFolder folder;
  const auto ready = folder.path() + "/ready";
  ChildProcess stubborn(shell("trap '' TERM; touch " + ready + "; while :; do sleep 1; done"));
  ChildProcess polite(shell("exit 0"));
  ASSERT_TRUE(comes_true([&] { return std::filesystem::exists(ready); }));
  std::vector<pid_t> slow;
  end_all(
      {&stubborn, &polite}, 50, [] { return false; },
      [&](const ChildProcess& each) { slow.push_back(each.id()); });
  EXPECT_EQ(slow, std::vector{stubborn.id()});
  EXPECT_EQ(stubborn.how_it_ended(), "was killed by signal 9 (Killed)");
  EXPECT_EQ(polite.how_it_ended(), "ended with exit code 0");
}

TEST(ChildProcess, HurrySkipsThePatience) {
  ChildProcess child(shell("sleep 60"));
  const auto start = std::chrono::steady_clock::now();
  end_all({&child}, 1000 * 3600, [] { return true; });
  EXPECT_LT(std::chrono::steady_clock::now() - start, hang);
}

}  // namespace
}  // namespace ziggurat::processes
