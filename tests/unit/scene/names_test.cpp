// SPDX-License-Identifier: MIT
#include "scene/names.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scene/report.h"

namespace ziggurat::scene {
namespace {

TEST(Nearest, IsFoundOnlyWithinAFewEdits) {
  constexpr std::array<std::string_view, 3> names{"position", "orientation", "size"};
  EXPECT_EQ(nearest("positon", names), "position");
  EXPECT_EQ(nearest("colour", names), std::nullopt);
  EXPECT_EQ(nearest(std::string(100000, 'p'), names), std::nullopt);
}

TEST(Ids, NumbersUnnamedElementsFromZero) {
  Ids ids;
  EXPECT_TRUE(ids.add("front"));
  EXPECT_EQ(ids.next("magnet"), "magnet_0");
  EXPECT_TRUE(ids.add("magnet_1"));
  EXPECT_EQ(ids.next("magnet"), "magnet_2");
  EXPECT_FALSE(ids.add("magnet_0"));
}

TEST(Names, OnlyTheFirstMistakesGetASuggestion) {
  const std::vector<std::string> files{"scene"}, known{"left", "right"};
  Report report(files);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(report.advice("rigth", known), "did you mean \"right\"?");
  EXPECT_EQ(report.advice("rigth", known), "known here: left, right");
}

TEST(Names, AreListedOnceEach) {
  std::vector<std::string_view> known{"id", "orientation", "position", "orientation"};
  EXPECT_EQ(list_known(known), "known here: id, orientation, position");
  for (int i = 0; i < 20; ++i) known.push_back("position");
  EXPECT_EQ(list_known(known), "known here: id, orientation, position");
  const std::vector<std::string> others{"a", "b", "c", "d", "e", "f", "g",
                                        "h", "i", "j", "k", "l", "m"};
  known.assign(others.begin(), others.end());
  EXPECT_EQ(list_known(known), "known here: a, b, c, d, e, f, g, h, i, j, k, l, …");
}

}  // namespace
}  // namespace ziggurat::scene
