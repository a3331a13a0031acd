// SPDX-License-Identifier: MIT
// The tree of boxes that tells which colliders come near each other.

#include "physics/collision/colliders.h"

#include <gtest/gtest.h>

#include "../newton_scene.h"
#include "physics/build.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Depth of the tree for boxes in a row that come one after another.
int depth_of_row(std::size_t count) {
  const scene::Physics physics = newton();
  Colliders colliders;
  for (std::size_t i = 0; i < count; ++i) {
    const scene::Entity entity = standing(at(3.0 * static_cast<double>(i), 0, 0), cube);
    const Body body = make_body(entity, physics, i);
    colliders.add(body, entity, make_tree(body, entity, physics));
  }
  return colliders.tree_depth();
}

TEST(Colliders, InARowMakeNoListOfTheTree) {
  EXPECT_LE(depth_of_row(1024), 20);  // 11 levels at least; as a list more than 1000
  EXPECT_LE(depth_of_row(1000), 20);
}

}  // namespace
}  // namespace ziggurat::physics
