// SPDX-License-Identifier: MIT
#include "text/numbers.h"

#include <gtest/gtest.h>

#include <array>

namespace ziggurat::text {
namespace {

TEST(Numbers, IntegersAreWholeAndNotNegative) {
  EXPECT_EQ(to_integer("--n", "18446744073709551615"), 18446744073709551615u);
  for (const std::string text : {"", "-1", "1.5", "1x", " 1", "18446744073709551616", "0x10"}) {
    EXPECT_THROW(to_integer("--n", text), UsageError) << text;
  }
}

TEST(Numbers, NumbersAreFinite) {
  EXPECT_EQ(to_number("--x", "2.5e-1"), 0.25);
  for (const std::string text : {"", "nan", "inf", "1e999", "1,5", "fast"}) {
    EXPECT_THROW(to_number("--x", text), UsageError) << text;
  }
}

TEST(Numbers, ListsHaveAsManyNumbersAsPlacesAndNoMore) {
  std::array<double, 3> places{};
  to_numbers("position", "1,-2,.5", "x,y,z", places);
  EXPECT_EQ(places, (std::array{1.0, -2.0, 0.5}));
  for (const std::string text :
       {"1,2,3,4", "1,2", "", "1,2,3,", ",1,2,3", "1,2,x", "1 2 3", "1,2,nan", "1,,3"}) {
    EXPECT_THROW(to_numbers("position", text, "x,y,z", places), UsageError) << text;
  }
}

TEST(Numbers, SizesKnowTheirUnits) {
  EXPECT_EQ(to_size("--s", "100"), 100u);
  EXPECT_EQ(to_size("--s", "3K"), 3072u);
  EXPECT_EQ(to_size("--s", "64M"), std::size_t{64} << 20);
  EXPECT_THROW(to_size("--s", "M"), UsageError);
  EXPECT_THROW(to_size("--s", "18446744073709551615G"), UsageError);
}

TEST(Numbers, UnitsOfTimeHaveSeconds) {
  EXPECT_EQ(seconds_in("us"), 1e-6);
  EXPECT_EQ(seconds_in("ms"), 1e-3);
  EXPECT_EQ(seconds_in("s"), 1);
  EXPECT_EQ(seconds_in(""), std::nullopt);
  EXPECT_EQ(seconds_in("min"), std::nullopt);
}

TEST(Duration, HasTwoUnitsAtMostAndIsRoundedUp) {
  EXPECT_EQ(to_duration(0), "0 s");
  EXPECT_EQ(to_duration(44.2), "45 s");
  EXPECT_EQ(to_duration(59.5), "1 min 0 s");
  EXPECT_EQ(to_duration(200), "3 min 20 s");
  EXPECT_EQ(to_duration(7500), "2 h 5 min");
}

}  // namespace

}  // namespace ziggurat::text
