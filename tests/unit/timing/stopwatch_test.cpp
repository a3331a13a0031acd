// SPDX-License-Identifier: MIT
#include "timing/stopwatch.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace ziggurat::timing {
namespace {

using namespace std::chrono_literals;

void sleep() { std::this_thread::sleep_for(4ms); }  // elapsed time is the subject

TEST(Stopwatch, PhasesAddUpToTheTimeOfTheSystemsClock) {
  const auto begin = std::chrono::steady_clock::now();
  Stopwatch watch;
  sleep();
  watch.enter(Phase::solve);
  sleep();
  watch.enter(Phase::integrate);
  watch.enter(Phase::solve);
  sleep();
  watch.enter(Phase::wait);
  const PhaseTimes times = watch.take();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(times[Phase::startup], 3.9e-3);
  EXPECT_GE(times[Phase::solve], 7.9e-3);
  EXPECT_GE(times.physics(), times[Phase::solve]);
  const double sum = times.ticks() + times[Phase::startup];
  EXPECT_LE(sum, elapsed.count());
  EXPECT_GE(sum, 11.9e-3);
  EXPECT_EQ(watch.take()[Phase::solve], 0) << "taken times count once";
}

TEST(Stopwatch, DividesAStageAsItsThreadsDid) {
  Stopwatch watch(Phase::solve), first(Phase::solve), second(Phase::solve);
  std::thread other([&] {
    second.start(Phase::solve);
    sleep();
    second.stop();
  });
  first.start(Phase::integrate);
  sleep();
  first.stop();
  other.join();
  first.add(second);
  watch.divide_like(first);
  const PhaseTimes times = watch.take();
  EXPECT_GT(times[Phase::solve], 1e-3) << "wall time, not the sum over threads";
  EXPECT_GT(times[Phase::integrate], 1e-3);
  EXPECT_GE(times.ticks(), 4e-3);
  second.start(Phase::wait);
  EXPECT_EQ(second.take().physics(), 0) << "what was added is cleared";
}

TEST(Phases, HaveNames) {
  EXPECT_EQ(std::string(phase_names[static_cast<std::size_t>(Phase::encode)]), "encode");
  EXPECT_EQ(std::string(phase_names[static_cast<std::size_t>(Phase::pacing)]), "pacing");
}

}  // namespace
}  // namespace ziggurat::timing
