// SPDX-License-Identifier: MIT
#include "sweep/plot.h"

#include <gtest/gtest.h>

#include <regex>
#include <vector>

#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

Result run_with(std::size_t run, double time) {
  Result result;
  result.run = run;
  result.metrics["time"] = time;
  return result;
}

/// Heights of the dots of a curve [px], downwards; the curve by its name in the legend.
std::vector<double> heights(const std::string& svg, const std::string& name) {
  static const std::regex curve(
      "<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"|<text[^>]*>([^<]*)</text>");
  std::vector<double> found;
  for (std::sregex_iterator match(svg.begin(), svg.end(), curve), end; match != end; ++match) {
    if ((*match)[2].matched) found.push_back(std::stod((*match)[2]));
    if (!(*match)[2].matched && !found.empty() && (*match)[3] == name) return found;
    if (!(*match)[2].matched) found.clear();
  }
  return found;
}

/// The length of the first error bar [px].
double bar(const std::string& svg) {
  static const std::regex ends("V([0-9.]+)h-4h8M[0-9.]+ [0-9.]+M[0-9.]+ [0-9.]+V([0-9.]+)h-4");
  std::smatch found;
  if (!std::regex_search(svg, found, ends)) return -1;
  return std::stod(found[1]) - std::stod(found[2]);
}

TEST(Plot, HasACurvePerValueWithItsMeansInOrder) {
  const Experiment experiment{
      "/s.argos",
      {{Axis::Kind::parameter, "gain", {"2", "1"}}, {Axis::Kind::parameter, "mode", {"it's", "b"}}},
      {1, 2},
      {}};
  std::vector<Result> results;
  for (std::size_t run = 1; run <= 8; ++run)
    results.push_back(run_with(run, static_cast<double>(run)));
  const std::string svg = to_svg(experiment, results, {0, 1, "time"});
  // Runs 1, 2: gain 2, first mode; 5, 6: gain 1. Means 5.5, then 1.5; the second mode's are 2
  // higher.
  const auto first = heights(svg, "mode = it's"), second = heights(svg, "mode = b");
  ASSERT_EQ(first.size(), 2u) << svg;
  ASSERT_EQ(second.size(), 2u) << svg;
  EXPECT_NEAR(first[1] - first[0], 2 * (first[0] - second[0]), 0.2) << "[px] of 4 and 2";
  EXPECT_NEAR(second[1] - second[0], first[1] - first[0], 0.2);
  EXPECT_NEAR(bar(svg), 2 * 6.353 / 4 * (first[1] - first[0]), 0.5) << "12.706 · √0.5 / √2 = 6.353";
}

TEST(Plot, NamesThatAreNoNumbersStandSideBySide) {
  const Experiment experiment{
      "/s.argos", {{Axis::Kind::parameter, "mode", {"a\u202e", "b"}}}, {1}, {}};
  const std::vector<Result> results = {run_with(1, 3), run_with(2, 4)};
  const std::string svg = to_svg(experiment, results, {0, {}, "time"});
  EXPECT_LT(svg.find(">a\\u202e<"), svg.find(">b<")) << svg;
  EXPECT_EQ(heights(svg, "").size(), 2u);
  EXPECT_EQ(bar(svg), 0) << "one value has no interval: " << svg;
}

TEST(Plot, OfNothingIsRefused) {
  const Experiment experiment{"/s.argos", {{Axis::Kind::parameter, "mode", {"a", "b"}}}, {1}, {}};
  EXPECT_THROW(to_svg(experiment, {}, {0, {}, "time"}), text::UsageError);
}

}  // namespace
}  // namespace ziggurat::sweep
