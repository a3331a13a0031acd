// SPDX-License-Identifier: MIT
#include "render/several.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "small_world.h"

namespace ziggurat::render {
namespace {

using math::Quaternion;
using testing::forward_view;
using testing::SmallWorld;

SmallWorld world_with_a_box() {
  SmallWorld world;
  world.scene.physics.floor.emplace();
  const auto box = world.add(scene::Box{{0.2, 0.3, 0.4}}, {{2, 0, -0.5}, Quaternion::Identity()});
  world.add_led(box, {0, 0, 0.4}, 0xFF0000);
  return world;
}

void put(SmallWorld& world, double y) {
  world.state.links[0].pose.position.y() = world.state.origins[0].position.y() = y;
}

TEST(Several, GivesTheSameBytesInTheSameOrderWithAnyNumberOfThreads) {
  SmallWorld world = world_with_a_box();
  const View view = forward_view(160, 120, 150);
  constexpr int pictures = 7;
  std::vector<std::vector<std::uint8_t>> one_by_one;
  for (int i = 0; i < pictures; ++i) {
    put(world, 0.1 * i);
    one_by_one.push_back(world.picture(view).rgb);
  }
  EXPECT_NE(one_by_one[0], one_by_one[1]);
  for (const unsigned threads : {1u, 2u, 3u}) {
    Several several(world.scene, world.entities, world.layout, threads);
    std::vector<std::vector<std::uint8_t>> all;
    for (int i = 0; i < pictures; ++i) {
      put(world, 0.1 * i);
      several.draw(world.state, {}, view,
                   [&](const Picture& picture) { all.push_back(picture.rgb); });
    }
    several.finish();
    EXPECT_EQ(all, one_by_one) << threads;
  }
}

TEST(Several, ThrowsOnceWhatATakeThrewAndTakesNoMore) {
  const SmallWorld world = world_with_a_box();
  const View view = forward_view(32, 24, 30);
  Several several(world.scene, world.entities, world.layout, 2);
  int taken = 0;
  several.draw(world.state, {}, view,
               [](const Picture&) { throw std::runtime_error("the disk is full"); });
  EXPECT_THROW(
      {
        for (int i = 0; i < 9; ++i)
          several.draw(world.state, {}, view, [&](const Picture&) { ++taken; });
        several.finish();
      },
      std::runtime_error);
  several.finish();
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace ziggurat::render
