// SPDX-License-Identifier: MIT
#include "render/shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ziggurat::render {
namespace {

TEST(ShadowMap, KnowsTheLeastDepthOfWhatALookupReaches) {
  ShadowMap map;
  map.begin();
  EXPECT_EQ(map.nearest(100, 100), 1);
  map.draw({{{100, 200, 0.5}, {140, 200, 0.5}, {100, 240, 0.5}}});
  EXPECT_FLOAT_EQ(*map.texels(110, 210), 0.5);
  EXPECT_EQ(*map.texels(139, 239), 1) << "beyond its slanted side";
  for (int y = 190; y < 250; ++y) {
    for (int x = 90; x < 150; ++x) {
      if (map.nearest(x, y) == 1) continue;
      float least = 1;
      for (int j = -1; j < 3; ++j) {
        const float* row = map.texels(x - 1, y + j);
        least = std::min(least, *std::min_element(row, row + 4));
      }
      EXPECT_LE(map.nearest(x, y), least) << x << ", " << y;
    }
  }
  EXPECT_LT(map.nearest(98, 198), 1);
  EXPECT_EQ(map.nearest(60, 200), 1);
  map.begin();
  EXPECT_EQ(map.nearest(110, 210), 1) << "forgotten";
}

TEST(ShadowMap, TakesTheNearestAndNothingThatTurnsAway) {
  ShadowMap map;
  map.begin();
  map.draw({{{10, 10, 0.7}, {60, 10, 0.7}, {10, 60, 0.7}}});
  map.draw({{{10, 10, 0.3}, {40, 10, 0.3}, {10, 40, 0.3}}});
  map.draw({{{10, 10, 0.8}, {60, 10, 0.8}, {10, 60, 0.8}}});
  map.draw({{{10, 10, 0.1}, {10, 60, 0.1}, {60, 10, 0.1}}});  // clockwise
  EXPECT_FLOAT_EQ(*map.texels(15, 15), 0.3);
  EXPECT_FLOAT_EQ(*map.texels(45, 15), 0.7);
}

TEST(ShadowMap, CutsWhatIsBeyondItsSides) {
  ShadowMap map;
  map.begin();
  map.draw({{{-1e6, -1e6, 0.4}, {1e6, -1e6, 0.4}, {0, 1e6, 0.4}}});
  EXPECT_NEAR(*map.texels(0, 0), 0.4, 1e-6);
  EXPECT_NEAR(*map.texels(shadow_size - 1, shadow_size - 1), 0.4, 1e-6);
  EXPECT_EQ(*map.texels(-1, 5), 1);
  EXPECT_EQ(*map.texels(5, shadow_size), 1);
}

}  // namespace
}  // namespace ziggurat::render
