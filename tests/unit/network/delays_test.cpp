// SPDX-License-Identifier: MIT
// Random draws for messages, and delay lines.

#include "network/delays.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ziggurat::network {
namespace {

using namespace std::chrono_literals;

TEST(Effect, DependsOnNothingButItsName) {
  const Disturbance disturbance{5ms, 2ms, 0.5};
  const auto draw = [&](std::uint64_t seed, const char* path, Direction direction,
                        std::uint64_t tick) {
    return draw_effect(disturbance, seed, path, direction, tick).delay;
  };
  const auto one = draw(1, "drive/r0", Direction::commands, 7);
  EXPECT_EQ(draw(1, "drive/r0", Direction::commands, 7), one);
  EXPECT_NE(draw(2, "drive/r0", Direction::commands, 7), one);
  EXPECT_NE(draw(1, "drive/r1", Direction::commands, 7), one);
  EXPECT_NE(draw(1, "drive/r0", Direction::observations, 7), one);
  EXPECT_NE(draw(1, "drive/r0", Direction::commands, 8), one);
}

TEST(Effect, DelaysAreUniformAndLossesHaveTheirShare) {
  const Disturbance disturbance{5ms, 2ms, 0.25};
  constexpr int draws = 20'000;
  double sum = 0, squares = 0;
  int lost = 0;
  for (std::uint64_t tick = 0; tick < draws; ++tick) {
    const Effect effect = draw_effect(disturbance, 3, "drive/r0", Direction::commands, tick);
    ASSERT_GE(effect.delay, 3ms);
    ASSERT_LE(effect.delay, 7ms);
    const double off = (static_cast<double>(effect.delay.count()) - 5e6) / 2e6;
    sum += off;
    squares += off * off;
    lost += effect.is_lost ? 1 : 0;
    // Delays change no losses.
    ASSERT_EQ(draw_effect({{}, {}, 0.25}, 3, "drive/r0", Direction::commands, tick).is_lost,
              effect.is_lost);
  }
  // Four standard deviations of what a uniform number in [-1, 1] and a coin give.
  EXPECT_NEAR(sum / draws, 0, 4 * std::sqrt(1.0 / 3 / draws));
  EXPECT_NEAR(squares / draws, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / draws));
  EXPECT_NEAR(lost, draws * 0.25, 4 * std::sqrt(draws * 0.25 * 0.75));
}

TEST(Effect, AllOrNothing) {
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    EXPECT_TRUE(draw_effect({{}, {}, 1}, 1, "", Direction::commands, tick).is_lost);
    EXPECT_FALSE(draw_effect({5ms, {}, 0}, 1, "", Direction::commands, tick).is_lost);
    EXPECT_EQ(draw_effect({5ms, {}, 0}, 1, "", Direction::commands, tick).delay, 5ms);
  }
}

TEST(DelayLine, NoneOvertakes) {
  DelayLine<int> line;
  const DelayLine<int>::Time now;
  line.push(now + 9ms, 1);
  line.push(now + 2ms, 2);
  EXPECT_EQ(line.due(), now + 9ms);
  EXPECT_FALSE(line.pop(now + 8ms));
  EXPECT_EQ(line.pop(now + 9ms), 1);
  EXPECT_EQ(line.pop(now + 9ms), 2);
  EXPECT_EQ(line.due(), DelayLine<int>::Time::max());
}

}  // namespace
}  // namespace ziggurat::network
