#include "sweep/plot.h"

#include <gtest/gtest.h>

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

TEST(Plot, HasACurvePerValueWithItsMeansInOrder) {
  const Experiment experiment{
      "/s.argos",
      {{Axis::Kind::parameter, "gain", {"2", "1"}}, {Axis::Kind::parameter, "mode", {"it's", "b"}}},
      {1, 2},
      {}};
  std::vector<Result> results;
  for (std::size_t run = 1; run <= 8; ++run)
    results.push_back(run_with(run, static_cast<double>(run)));
  const std::string text = gnuplot_program(experiment, results, {0, 1, "time"}, "a.svg");
  // Runs 1, 2: gain 2, first mode; 5, 6: gain 1. Intervals: 12.706 · √0.5 / √2 = 6.353.
  EXPECT_NE(text.find("$curve0 << END\n1 5.5 6.35"), std::string::npos) << text;
  EXPECT_NE(text.find("\n2 1.5 6.35"), std::string::npos) << text;
  EXPECT_NE(text.find("title 'mode = it''s'"), std::string::npos) << text;
  EXPECT_NE(text.find("$curve1 using 1:2:3"), std::string::npos) << text;
}

TEST(Plot, NamesThatAreNoNumbersStandSideBySide) {
  const Experiment experiment{
      "/s.argos", {{Axis::Kind::parameter, "mode", {"a\u202e", "b"}}}, {1}, {}};
  const std::vector<Result> results = {run_with(1, 3), run_with(2, 4)};
  const std::string text = gnuplot_program(experiment, results, {0, {}, "time"}, "a.svg");
  EXPECT_NE(text.find("set xtics ('a\\u202e' 0, 'b' 1)"), std::string::npos) << text;
  EXPECT_NE(text.find("0 3 0\n1 4 0\n"), std::string::npos)
      << "one value has no interval: " << text;
}

TEST(Plot, TheProgramStandsBesideThePicture) {
  EXPECT_EQ(program_beside("a/b.svg"), "a/b.gnuplot");
}

TEST(Plot, OfNothingIsRefused) {
  const Experiment experiment{"/s.argos", {{Axis::Kind::parameter, "mode", {"a", "b"}}}, {1}, {}};
  EXPECT_THROW(gnuplot_program(experiment, {}, {0, {}, "time"}, "a.svg"), text::UsageError);
}

}  // namespace
}  // namespace ziggurat::sweep
