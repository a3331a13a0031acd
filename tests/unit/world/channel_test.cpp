// SPDX-License-Identifier: MIT
#include "world/channel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::world {
namespace {

struct Small {
  std::vector<double> first;
  std::vector<double> second;
  std::uint64_t third = 0;
};
constexpr ByHand first{&Small::first, Hashed::no};
constexpr ByHand second{&Small::second, Hashed::no};
constexpr ByHand third{&Small::third, Hashed::no};

constexpr std::tuple whole{first, second, third};
constexpr std::tuple too_short{first, third};
constexpr std::tuple twice{first, second, first};
constexpr std::tuple too_long{first, second, third, second};

TEST(Table, ListsEachFieldOnce) {
  EXPECT_EQ(field_count<Small>(), 3U);
  EXPECT_TRUE(lists_all_fields<Small>(whole));
  EXPECT_FALSE(lists_all_fields<Small>(too_short));
  EXPECT_FALSE(lists_all_fields<Small>(twice));
  EXPECT_FALSE(lists_all_fields<Small>(too_long));
}

TEST(Table, FindsTheRowOfAField) {
  EXPECT_EQ(row_of(whole, &Small::second), 1U);
  EXPECT_EQ(row_of(too_short, &Small::second), 2U) << "there is none";
}

TEST(Table, TellsChannelsFromFieldsHandledByHand) {
  std::vector<std::string> names;
  for_each_channel(commanded, [&](auto i) { names.emplace_back(std::get<i>(commanded).name); });
  EXPECT_EQ(names.size() + 4, std::tuple_size_v<decltype(commanded)>)
      << "all but radio messages, pushes, paints and markers";
  EXPECT_EQ(names.front(), "joint_targets");
}

TEST(Numbers, InTheOrderOfTheFields) {
  EXPECT_EQ(numbers(WheelsReading{1, 2, 3, 4}), (std::array<double, 4>{1, 2, 3, 4}));
  EXPECT_EQ(width<WheelsReading>, 4U);
  EXPECT_EQ(width<std::string>, 1U);
  const math::Pose pose{{1, 2, 3}, math::Quaternion(0.5, -0.5, 0.25, 0.75)};
  EXPECT_EQ(numbers(pose), (std::array<double, 7>{1, 2, 3, 0.5, -0.5, 0.25, 0.75}));
}

TEST(Devices, OfARobotThatUsesThemSo) {
  Layout layout;
  layout.wheels = {{.entity = 0, .axle_length = 0.1, .drives = true},
                   {.entity = 1, .axle_length = 0.1, .measures = true}};
  RobotLayout driver, walker;
  driver.wheels = {0, 1};
  EXPECT_EQ(driven_wheels(layout, driver).count, 1U);
  driver.wheels = {1, 1};
  EXPECT_EQ(driven_wheels(layout, driver).count, 0U) << "it only measures";
  EXPECT_EQ(driven_wheels(layout, walker).count, 0U);
}

}  // namespace
}  // namespace ziggurat::world
