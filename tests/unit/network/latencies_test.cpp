// SPDX-License-Identifier: MIT
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
  EXPECT_EQ(none.count(), 0U);
}

TEST(Latencies, PercentilesOfOneToAHundred) {
  Latencies times;
  for (int i = 100; i >= 1; --i) times.add(i * 1e-3);
  const wire::Latency recent = times.recent();
  EXPECT_FLOAT_EQ(static_cast<float>(recent.p50), 0.050F);
  EXPECT_FLOAT_EQ(static_cast<float>(recent.p99), 0.099F);
  EXPECT_FLOAT_EQ(static_cast<float>(recent.max), 0.100F);
}

TEST(Latencies, OnlyTheLastThousandAreRecent) {
  Latencies times;
  times.add(9);
  for (std::uint64_t i = 1; i <= Latencies::remembered; ++i) times.add(1e-3);
  EXPECT_FLOAT_EQ(static_cast<float>(times.recent().max), 1e-3F);
  EXPECT_EQ(times.count(), Latencies::remembered + 1);
}

TEST(Latencies, PercentilesOfTheLastThousandAreExact) {
  Latencies times;
  std::vector<float> all;
  std::uint64_t state = 1;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const double seconds = static_cast<double>(state >> 52) * 1e-4;  // of 4096 values: many twice
    times.add(seconds);
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

TEST(AnswerTimes, EachTimeIsInItsBin) {
  AnswerTimes times;
  times.add(0);
  times.add(1.3e-5);
  times.add(2.1e-5);
  times.add(1e9);
  EXPECT_EQ(times.counts[0], 2u);
  EXPECT_EQ(times.counts[2], 1u);
  EXPECT_EQ(times.counts.back(), 1u);
  times = {};
  times.add(1e-3);
  const auto bin = static_cast<int>(std::ranges::find(times.counts, 1u) - times.counts.begin());
  EXPECT_LE(AnswerTimes::least * std::pow(AnswerTimes::growth, bin), 1e-3);
  EXPECT_GT(AnswerTimes::least * std::pow(AnswerTimes::growth, bin + 1), 1e-3);
}

}  // namespace
}  // namespace ziggurat::network
