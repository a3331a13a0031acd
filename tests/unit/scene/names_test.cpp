#include "scene/names.h"

#include <gtest/gtest.h>

#include <array>

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

}  // namespace
}  // namespace ziggurat::scene
