// SPDX-License-Identifier: MIT
#include "math/hash.h"

#include <gtest/gtest.h>

namespace ziggurat::math {
namespace {

TEST(Hash, OfNoDataIsThePublishedValueOfXxh64) {
  EXPECT_EQ(to_hex(Hash().digest()), "ef46db3751d8e999");
}

TEST(Hash, DependsOnEveryBit) {
  Hash zero, minus_zero, twice;
  zero.add(0.0);
  minus_zero.add(-0.0);
  twice.add(0.0);
  twice.add(0.0);
  EXPECT_NE(zero.digest(), minus_zero.digest());
  EXPECT_NE(zero.digest(), twice.digest());
}

TEST(Hash, DependsOnTheBoundaryBetweenTexts) {
  Hash one, two;
  one.add("ab");
  one.add("c");
  two.add("a");
  two.add("bc");
  EXPECT_NE(one.digest(), two.digest());
}

}  // namespace
}  // namespace ziggurat::math
