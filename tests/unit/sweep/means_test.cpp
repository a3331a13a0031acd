// SPDX-License-Identifier: MIT
#include "sweep/means.h"

#include <gtest/gtest.h>

#include <cmath>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::sweep {
namespace {

// Values of Student's t, two-sided 95 %: 12.706 for 1 degree of freedom, 2.776 for 4; 99 %: 4.604.
TEST(Estimate, HasTheIntervalOfStudentsT) {
  const std::vector<double> values = {1, 2, 3, 4, 5};  // mean 3, s² = 2.5
  const Estimate e = estimate(values, 0.95);
  EXPECT_EQ(e.count, 5u);
  EXPECT_DOUBLE_EQ(e.mean, 3);
  EXPECT_NEAR(e.half_width, 2.776 * std::sqrt(2.5 / 5), 1e-3);
  EXPECT_NEAR(estimate(values, 0.99).half_width, 4.604 * std::sqrt(2.5 / 5), 1e-3);
  const std::vector<double> two = {0, 2};  // s² = 2
  EXPECT_NEAR(estimate(two, 0.95).half_width, 12.706 * std::sqrt(2.0 / 2), 1e-2);
}

TEST(Estimate, OfOneValueHasNoInterval) {
  const std::vector<double> one = {4};
  EXPECT_DOUBLE_EQ(estimate(one, 0.95).mean, 4);
  EXPECT_TRUE(std::isnan(estimate(one, 0.95).half_width));
  EXPECT_TRUE(std::isnan(estimate({}, 0.95).mean));
}

Experiment two_axes() {
  return {"/s.argos",
          {{Axis::Kind::parameter, "gain", {"1", "2"}},
           {Axis::Kind::setting, "physics_engines/dynamics3d/@iterations", {"5", "10"}}},
          {1, 2},
          {}};
}

Result timed(std::size_t run, double time, Outcome outcome = Outcome::finished) {
  Result result;
  result.run = run;
  result.outcome = outcome;
  result.metrics["time"] = time;
  return result;
}

TEST(Group, AveragesOverAllThatWasNotAskedFor) {
  const std::vector<Result> results = {timed(1, 1), timed(2, 3),  timed(3, 5),
                                       timed(4, 7), timed(5, 10), timed(6, 99, Outcome::failed)};
  const std::vector<std::size_t> axes = {0};
  const std::vector<std::string> measures = {"time", "ticks"};
  const auto groups = group(two_axes(), results, axes, measures, 0.95);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].values, std::vector<std::string>{"1"});
  EXPECT_EQ(groups[0].finished, 4u);
  EXPECT_DOUBLE_EQ(groups[0].estimates[0].mean, 4);
  EXPECT_EQ(groups[0].estimates[1].count, 0u) << "no run has ticks";
  EXPECT_EQ(groups[1].finished, 1u);
  EXPECT_EQ(groups[1].failed, 1u) << "and its value does not count";
  EXPECT_DOUBLE_EQ(groups[1].estimates[0].mean, 10);
}

TEST(Axes, HaveShortNames) {
  EXPECT_EQ(axis_named(two_axes(), "iterations"), 1u);
  EXPECT_EQ(axis_named(two_axes(), "physics_engines/dynamics3d/@iterations"), 1u);
  EXPECT_EQ(axis_named(two_axes(), "gain"), 0u);
  EXPECT_TRUE(
      fails_with<text::UsageError>("did you mean 'gain'", [&] { axis_named(two_axes(), "gian"); }));
}

TEST(Measures, AreMetricsFirst) {
  const std::vector<Result> results = {timed(1, 1)};
  EXPECT_EQ(measures_of(results).front(), "time");
  EXPECT_TRUE(std::isnan(value_of(results[0], "nothing")));
}

}  // namespace
}  // namespace ziggurat::sweep
