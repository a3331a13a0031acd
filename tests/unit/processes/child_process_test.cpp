#include "processes/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#include "processes/private_folder.h"

namespace ziggurat::processes {
namespace {

using namespace std::chrono_literals;

Program shell(const std::string& command) { return {{"/bin/sh", "-c", command}, {}}; }

template <class Condition>
bool soon(Condition condition) {
  for (int i = 0; i < 5000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
  return condition();
}

std::string end_of(const std::string& command) {
  ChildProcess child(shell(command));
  EXPECT_TRUE(soon([&] { return child.poll(); }));
  return child.how_it_ended();
}

TEST(ChildProcess, SaysHowItEnded) {
  EXPECT_EQ(end_of("exit 0"), "ended with exit code 0");
  EXPECT_EQ(end_of("exit 7"), "ended with exit code 7");
  EXPECT_EQ(end_of("kill -9 $$"), "was killed by signal 9 (Killed)");
}

TEST(ChildProcess, HasWhatTheProgramAsksForInItsEnvironment) {
  ChildProcess child({{"/bin/sh", "-c", "test \"$A\" = x && test -n \"$PATH\""}, {{"A", "x"}}});
  EXPECT_TRUE(soon([&] { return child.poll(); }));
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
  const auto ready = folder.path() + "/ready", late = folder.path() + "/late";
  {
    ChildProcess child(shell("(sleep 0.3; touch " + late + ") & touch " + ready + "; wait"));
    ASSERT_TRUE(soon([&] { return std::filesystem::exists(ready); }));
  }
  std::this_thread::sleep_for(500ms);
  EXPECT_FALSE(std::filesystem::exists(late));
}

TEST(ChildProcess, StubbornOnesAreKilledInTheEnd) {
  const PrivateFolder folder;
  const auto ready = folder.path() + "/ready";
  ChildProcess stubborn(shell("trap '' TERM; touch " + ready + "; while :; do sleep 1; done"));
  ChildProcess polite(shell("exit 0"));
  ASSERT_TRUE(soon([&] { return std::filesystem::exists(ready); }));
  std::vector<pid_t> slow;
  end_all({&stubborn, &polite}, 50, [] { return false; }, [&](const ChildProcess& each) { slow.push_back(each.id()); });
  EXPECT_EQ(slow, std::vector{stubborn.id()});
  EXPECT_EQ(stubborn.how_it_ended(), "was killed by signal 9 (Killed)");
  EXPECT_EQ(polite.how_it_ended(), "ended with exit code 0");
}

TEST(ChildProcess, HurrySkipsThePatience) {
  ChildProcess child(shell("sleep 60"));
  const auto start = std::chrono::steady_clock::now();
  end_all({&child}, 30'000, [] { return true; });
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
}

}  // namespace
}  // namespace ziggurat::processes
