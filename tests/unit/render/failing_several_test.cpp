// SPDX-License-Identifier: MIT
// Threads for pictures that can't all be started: each allocation of their begin is made to fail
// once.

#include <gtest/gtest.h>

#include <cstddef>
#include <new>

#include "allocations/allocations.h"
#include "render/several.h"
#include "small_world.h"

namespace ziggurat::render {
namespace {

/// Whether two threads could be started although that allocation fails.
bool can_start(const testing::SmallWorld& world, std::size_t failing) {
  world::Layout layout = world.layout;
  std::vector<scene::Entity> entities = world.entities;
  const ziggurat::testing::FailingAllocation out_of_memory(failing);
  try {
    const Several several(world.scene, std::move(entities), std::move(layout), 2);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

TEST(Several, EndsTheThreadsThatItHasWhenAnotherCantBeStarted) {
  testing::SmallWorld world;
  world.scene.physics.floor.emplace();
  world.add(scene::Box{{0.2, 0.3, 0.4}}, {{2, 0, -0.5}, math::Quaternion::Identity()});
  std::size_t failures = 0;
  while (!can_start(world, failures)) ++failures;
  EXPECT_GT(failures, 5U);  // of both threads
}

}  // namespace
}  // namespace ziggurat::render
