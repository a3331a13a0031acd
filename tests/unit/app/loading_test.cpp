#include "app/loading.h"

#include <gtest/gtest.h>

#include "app/arguments.h"

namespace ziggurat::app {
namespace {

scene::Scene scene_of(double length, unsigned ticks_per_second) {
  scene::Scene scene;
  scene.experiment.length = length;
  scene.experiment.ticks_per_second = ticks_per_second;
  return scene;
}

TEST(TickCount, IsTheLengthInTicks) {
  EXPECT_EQ(tick_count({}, scene_of(60, 5)), 300u);
  EXPECT_EQ(tick_count({}, scene_of(0.25, 10)), 2u) << "a tick that isn't whole is left out";
  EXPECT_EQ(tick_count({}, scene_of(0.29, 100)), 29u) << "though the product is 28.999999999999996";
  EXPECT_EQ(tick_count({}, scene_of(0, 10)), std::nullopt) << "until somebody stops it";
}

TEST(TickCount, CommandLineWins) {
  Options ticks, duration, endless;
  ticks.ticks = 0;
  duration.duration = 2;
  endless.duration = 0;
  EXPECT_EQ(tick_count(ticks, scene_of(60, 5)), 0u);
  EXPECT_EQ(tick_count(duration, scene_of(60, 5)), 10u);
  EXPECT_EQ(tick_count(endless, scene_of(60, 5)), std::nullopt);
}

TEST(TickCount, ExtremesAreNoSurprise) {
  EXPECT_THROW(tick_count({}, scene_of(0.001, 10)), UsageError);
  EXPECT_EQ(tick_count({}, scene_of(1e300, 10)), std::uint64_t{1} << 63);
}

TEST(Seed, CommandLineWinsAndZeroDrawsOne) {
  auto scene = scene_of(1, 1);
  scene.experiment.random_seed = 5;
  Options options;
  EXPECT_EQ(choose_seed(options, scene), 5u);
  options.seed = 9;
  EXPECT_EQ(choose_seed(options, scene), 9u);
  options.seed = 0;
  const auto first = choose_seed(options, scene);
  EXPECT_NE(first, 0u);
  EXPECT_TRUE(choose_seed(options, scene) != first || choose_seed(options, scene) != first);
}

}  // namespace
}  // namespace ziggurat::app
