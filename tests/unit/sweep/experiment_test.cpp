// SPDX-License-Identifier: MIT
#include "sweep/experiment.h"

#include <gtest/gtest.h>

#include <set>

#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

using Seeds = std::vector<std::uint64_t>;
using Texts = std::vector<std::string>;

Experiment grid() {
  return {"/s.argos",
          {{Axis::Kind::parameter, "gain", {"0.5", "1", "2"}},
           {Axis::Kind::setting, "a/@b", {"x", "y"}}},
          {7, 8, 9, 10},
          {}};
}

TEST(Experiment, HasEachCombinationOnce) {
  const Experiment experiment = grid();
  ASSERT_EQ(run_count(experiment), 24u);
  std::set<std::pair<Texts, std::uint64_t>> seen;
  for (std::size_t run = 1; run <= 24; ++run) {
    const Combination each = combination(experiment, run);
    EXPECT_EQ(each.run, run);
    EXPECT_TRUE(seen.emplace(each.values, each.seed).second);
  }
}

TEST(Experiment, SeedsChangeFastestAndTheFirstAxisMostSlowly) {
  const Experiment experiment = grid();
  EXPECT_EQ(combination(experiment, 1).seed, 7u);
  EXPECT_EQ(combination(experiment, 2).seed, 8u);
  EXPECT_EQ(combination(experiment, 5).values, (Texts{"0.5", "y"}));
  EXPECT_EQ(combination(experiment, 9).values, (Texts{"1", "x"}));
  EXPECT_EQ(combination(experiment, 24).values, (Texts{"2", "y"}));
}

TEST(Experiment, WithoutAxesHasARunPerSeed) {
  EXPECT_EQ(run_count({"/s.argos", {}, {1, 2, 3}, {}}), 3u);
}

TEST(Axis, OfASettingSplitsAtTheFirstEqualsOutsideOfBrackets) {
  const Axis axis = to_axis(Axis::Kind::setting, "arena/box[@id='a|b']/@size=1,2,3|4,5,6");
  EXPECT_EQ(axis.name, "arena/box[@id='a|b']/@size");
  EXPECT_EQ(axis.values, (Texts{"1,2,3", "4,5,6"}));
}

TEST(Axis, ABarInAValueIsEscaped) {
  EXPECT_EQ(to_axis(Axis::Kind::parameter, R"(mode=a\|b|c)").values, (Texts{"a|b", "c"}));
}

TEST(Axis, WithoutEqualsIsRefused) {
  EXPECT_THROW(to_axis(Axis::Kind::parameter, "gain"), text::UsageError);
  EXPECT_THROW(to_axis(Axis::Kind::setting, "a/@b"), text::UsageError);
}

TEST(Seeds, AreRangesAndNumbers) {
  EXPECT_EQ(to_seeds("--seeds", "3..5"), (Seeds{3, 4, 5}));
  EXPECT_EQ(to_seeds("--seeds", "1, 7 ,9..10"), (Seeds{1, 7, 9, 10}));
}

TEST(Seeds, ThatCantBeAreRefused) {
  for (const char* text : {"", "5..3", "a", "1..", "..", "-1", "1,,2", "1..99999999999"}) {
    EXPECT_THROW(to_seeds("--seeds", text), text::UsageError) << text;
  }
}

TEST(Experiment, ThatCantBeRunIsRefused) {
  const auto refused = [](auto change) {
    Experiment experiment = grid();
    change(experiment);
    EXPECT_THROW(check(experiment), text::UsageError);
  };
  EXPECT_NO_THROW(check(grid()));
  refused([](Experiment& e) { e.seeds.push_back(7); });
  refused([](Experiment& e) { e.seeds.push_back(0); });
  refused([](Experiment& e) { e.seeds.push_back(std::uint64_t{1} << 63); });
  refused([](Experiment& e) { e.axes[0].values.push_back("1"); });
  refused([](Experiment& e) { e.axes[1].name = "gain"; });
  refused([](Experiment& e) { e.axes[0].values.clear(); });
  for (const char* value : {"nan", "inf", "-inf", "1e999"}) {
    refused([&](Experiment& e) { e.axes[0].values.push_back(value); });  // among numbers
    refused([&](Experiment& e) { e.axes[0].values = {value}; });
  }
  Experiment words = grid();
  words.axes[0].values = {"none", "inf"};
  EXPECT_NO_THROW(check(words));
  refused([](Experiment& e) { e.seeds = to_seeds("--seeds", "1..5000000"); });
}

}  // namespace
}  // namespace ziggurat::sweep
