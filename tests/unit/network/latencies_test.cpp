#include "network/latencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ziggurat::network {
namespace {

TEST(Latencies, NothingYet) {
  const Latencies none;
  EXPECT_EQ(none.recent().p99, 0);
  EXPECT_EQ(none.percentile(0.99), 0);
  EXPECT_EQ(none.max(), 0);
}

TEST(Latencies, PercentilesOfOneToAHundred) {
  Latencies times;
  for (int i = 100; i >= 1; --i) times.add(i * 1e-3, static_cast<std::uint64_t>(i));
  const wire::Latency recent = times.recent();
  EXPECT_FLOAT_EQ(static_cast<float>(recent.p50), 0.050F);
  EXPECT_FLOAT_EQ(static_cast<float>(recent.p99), 0.099F);
  EXPECT_FLOAT_EQ(static_cast<float>(recent.max), 0.100F);
  // From the histogram: within a bin, and never less.
  EXPECT_GE(times.percentile(0.5), 0.050);
  EXPECT_LE(times.percentile(0.5), 0.050 * Latencies::growth);
  EXPECT_EQ(times.percentile(1), 0.100);
}

TEST(Latencies, OnlyTheLastThousandAreRecent) {
  Latencies times;
  times.add(9, 0);
  for (std::uint64_t i = 1; i <= Latencies::remembered; ++i) times.add(1e-3, i);
  EXPECT_FLOAT_EQ(static_cast<float>(times.recent().max), 1e-3F);
  EXPECT_EQ(times.max(), 9);
  EXPECT_EQ(times.count(), Latencies::remembered + 1);
}

TEST(Latencies, PercentilesOfTheLastThousandAreExact) {
  Latencies times;
  std::vector<float> all;
  std::uint64_t state = 1;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const double seconds = static_cast<double>(state >> 52) * 1e-4;  // of 4096 values: many twice
    times.add(seconds, i);
    all.push_back(static_cast<float>(seconds));
    if (i % 97 != 0) continue;
    const auto size = std::min<std::ptrdiff_t>(std::ssize(all), Latencies::remembered);
    std::vector<float> last(all.end() - size, all.end());
    std::ranges::sort(last);
    const auto place = [&](double share) {
      return last[static_cast<std::size_t>(std::ceil(share * static_cast<double>(size))) - 1];
    };
    ASSERT_EQ(static_cast<float>(times.recent().p50), place(0.5)) << i;
    ASSERT_EQ(static_cast<float>(times.recent().p99), place(0.99)) << i;
    ASSERT_EQ(static_cast<float>(times.recent().max), last.back()) << i;
  }
}

TEST(Latencies, TheWorstAreKeptWithTheirTicks) {
  Latencies times;
  for (std::uint64_t i = 0; i < 50; ++i) times.add(1e-3 * static_cast<double>(i % 10 + 1), i);
  const auto worst = times.worst();
  ASSERT_EQ(worst.size(), 5U);
  for (const auto& each : worst) EXPECT_EQ(each.tick % 10, 9U);
}

TEST(Latencies, BinsGrowByTheirFactorAndHoldTheExtremes) {
  EXPECT_NEAR(Latencies::begin_of(21) / Latencies::begin_of(20), Latencies::growth, 1e-12);
  Latencies times;
  times.add(0, 0);
  times.add(1e9, 1);
  EXPECT_EQ(times.histogram().front(), 1U);
  EXPECT_EQ(times.histogram().back(), 1U);
}

}  // namespace
}  // namespace ziggurat::network
