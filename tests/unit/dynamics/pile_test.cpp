// Heaps that fall, strike and come to rest.

#include "pile.h"

#include <gtest/gtest.h>

#include "../long_runs.h"

namespace ziggurat::dynamics {
namespace {

double energy(const testing::Touching& world) {
  double total = 0;
  for (const Tree& tree : world.system.trees) total += testing::energy(tree);
  return total;
}

TEST(Pile, CubesInABinComeToRestWithinTheContactLaw) {
  testing::Touching world = testing::pile(long_runs::is_slow ? 5 : 20);
  double before = energy(world);
  for (int i = 0; i < 150; ++i) {
    const Report report = world.step(0.01);
    EXPECT_LT(report.miss, 1e-4) << i;
    // Undoing overlaps lifts bodies a little.
    const double now = energy(world);
    EXPECT_LT(now, before + 1e-5) << i;
    before = now;
  }
  for (const Tree& tree : world.system.trees) EXPECT_LT(tree.velocity(0).norm(), 1e-6);
}

TEST(Pile, CubesThatStrikeMissTheContactLawByLessThanAMillimetrePerSecond) {
  testing::Touching world = testing::pile(long_runs::is_slow ? 15 : 50);
  for (int i = 0; i < 60; ++i) EXPECT_LT(world.step(0.01).miss, 1e-3) << i;
}

}  // namespace
}  // namespace ziggurat::dynamics
