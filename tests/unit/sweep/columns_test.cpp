// SPDX-License-Identifier: MIT
#include "sweep/columns.h"

#include <gtest/gtest.h>

namespace ziggurat::sweep {
namespace {

TEST(Csv, HasARowPerRunAndQuotesWhatNeedsIt) {
  const Experiment experiment{
      "/s.argos", {{Axis::Kind::setting, "arena/@size", {"1,2,3"}}}, {5}, {}};
  Result result;
  result.run = 1;
  result.seed = 5;
  result.ending = "finished";
  result.ticks = 20;
  result.simulated_s = 0.1;
  result.hash = "00ff";
  result.metrics = {{"say \"x\"", 0.25}};
  result.wall_s = 1.23456;
  result.version = "0.1.0";
  const std::vector<Result> results = {result};
  EXPECT_EQ(
      to_csv(experiment, results),
      "run,arena/@size,seed,outcome,exit_code,ending,ticks,simulated_s,robots,failures,dropped,"
      "solver_not_converged,solver_worst_residual,hash,\"say \"\"x\"\"\",wall_s,version\n"
      "1,\"1,2,3\",5,finished,0,finished,20,0.1,,,,,,00ff,0.25,1.235,0.1.0\n");
}

TEST(Columns, HaveNamesOfTheirOwn) {
  const Experiment experiment{
      "/s.argos",
      {{Axis::Kind::parameter, "seed", {"1"}}, {Axis::Kind::parameter, "gain", {"1"}}},
      {5},
      {}};
  Result result;
  result.run = 1;
  result.metrics = {{"gain", 1}, {"ticks", 2}, {"fine", 3}};
  const std::vector<Result> results = {result};
  const Columns columns = columns_of(experiment, results);
  EXPECT_EQ(columns.axes, (std::vector<std::string>{"param_seed", "gain"}));
  EXPECT_EQ(columns.metrics.at("gain"), "metric_gain");
  EXPECT_EQ(columns.metrics.at("ticks"), "metric_ticks");
  EXPECT_EQ(columns.metrics.at("fine"), "fine");
}

TEST(Columns, DifferInMoreThanTheCaseOfLetters) {
  const Experiment experiment{"/s.argos", {{Axis::Kind::parameter, "Seed", {"1"}}}, {5}, {}};
  Result result;
  result.run = 1;
  result.metrics = {{"Load", 1}, {"load", 2}, {"LOAD", 3}};
  const std::vector<Result> results = {result};
  const Columns columns = columns_of(experiment, results);
  EXPECT_EQ(columns.axes[0], "param_Seed");
  EXPECT_EQ(columns.metrics.at("LOAD"), "LOAD");
  EXPECT_EQ(columns.metrics.at("Load"), "metric_Load");
  EXPECT_EQ(columns.metrics.at("load"), "metric_metric_load");
}

}  // namespace
}  // namespace ziggurat::sweep
