// SPDX-License-Identifier: MIT
// Limits of the number of contacts of a world.

#include <gtest/gtest.h>

#include "../newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

TEST(Contacts, AtTooManyPointsAreAFault) {
  EXPECT_EQ(
      fault_of_crowd(newton(), 1000),
      "bodies touch at more than 1000000 points; place fewer bodies, or farther from each other");
}

}  // namespace
}  // namespace ziggurat::physics
