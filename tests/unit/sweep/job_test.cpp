// SPDX-License-Identifier: MIT
#include "sweep/job.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ziggurat::sweep {
namespace {

std::vector<std::string> command(std::vector<std::string> run_arguments) {
  Experiment experiment;
  experiment.scene = "swarm.argos";
  experiment.seeds = {7};
  experiment.run_arguments = std::move(run_arguments);
  return run_command(experiment, combination(experiment, 1), "ziggurat", "folder", false);
}

TEST(RunCommand, GivesARunOneThreadBecauseOthersRunBesideIt) {
  const auto words = command({});
  const auto threads = std::ranges::find(words, "--threads");
  ASSERT_NE(threads, words.end());
  EXPECT_EQ(*(threads + 1), "1");
}

TEST(RunCommand, LeavesTheNumberOfThreadsToItsArguments) {
  for (const std::vector<std::string>& given :
       {std::vector<std::string>{"--threads", "2"}, {"--threads=2"}}) {
    const auto words = command(given);
    const auto is_threads = [](const auto& word) { return word.starts_with("--threads"); };
    EXPECT_EQ(std::ranges::count_if(words, is_threads), 1);
    EXPECT_TRUE(words.back().ends_with("2"));
  }
}

}  // namespace
}  // namespace ziggurat::sweep
