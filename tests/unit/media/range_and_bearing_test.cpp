// SPDX-License-Identifier: MIT
#include "media/range_and_bearing.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <string>

#include "scattered_devices.h"
#include "words_of.h"

namespace ziggurat::media {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;  // receiver, sender

Pairs sight(const testing::Scattered& world) {
  RangeAndBearingMedium medium;
  Pairs pairs;
  for (const Sighting& pair : medium.sight(world.layout, world.index())) {
    pairs.emplace_back(pair.receiver, pair.sender);
  }
  return pairs;
}

TEST(RangeAndBearing, PairsByTheSendersRangeInOrder) {
  testing::Scattered world;
  world.add_range_and_bearing({2, 0, 0}, 1.5, 4);
  world.add_range_and_bearing({0, 0, 0}, 3, 4);
  world.add_range_and_bearing({1, 0, 0}, 3, 4);
  EXPECT_EQ(sight(world), (Pairs{{0, 1}, {0, 2}, {1, 2}, {2, 0}, {2, 1}}));
}

TEST(RangeAndBearing, TooManyPairsEndWithASentence) {
  testing::Scattered world;
  for (int i = 0; i < 4; ++i) world.add_range_and_bearing({0.1 * i, 0, 0}, 3, 4);
  EXPECT_EQ(RangeAndBearingMedium(12).sight(world.layout, world.index()).size(), 12u);
  const std::string words = words_of<std::runtime_error>(
      [&] { RangeAndBearingMedium(11).sight(world.layout, world.index()); });
  EXPECT_NE(words.find("more than 11 pairs of the 4 devices"), std::string::npos) << words;
  EXPECT_NE(words.find("write a smaller range"), std::string::npos) << words;
}

TEST(RangeAndBearing, NeedsEqualSizesOneMediumAndASensor) {
  testing::Scattered world;
  for (int i = 0; i < 4; ++i) world.add_range_and_bearing({0.1 * i, 0, 0}, 3, i == 1 ? 8 : 4);
  world.layout.range_and_bearing[2].medium = 7;
  EXPECT_EQ(sight(world), (Pairs{{0, 3}, {3, 0}}));
  world.layout.range_and_bearing[3].receives = false;
  EXPECT_EQ(sight(world), (Pairs{{0, 3}}));
}

TEST(RangeAndBearing, GivesBearingsInTheReceiversFrame) {
  constexpr double pi = std::numbers::pi;
  const Bearing left = bearing_of({0, 2, 0});
  EXPECT_DOUBLE_EQ(left.range, 2);
  EXPECT_DOUBLE_EQ(left.horizontal, pi / 2);
  EXPECT_DOUBLE_EQ(left.vertical, 0);
  const Bearing below = bearing_of({-1, 0, -1});
  EXPECT_DOUBLE_EQ(below.range, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(below.horizontal, pi);
  EXPECT_DOUBLE_EQ(below.vertical, -pi / 4);
  EXPECT_DOUBLE_EQ(bearing_of({0, 0, 3}).vertical, pi / 2);
}

}  // namespace
}  // namespace ziggurat::media
