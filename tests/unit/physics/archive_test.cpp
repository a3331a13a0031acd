// SPDX-License-Identifier: MIT
// A state as bytes, of anyone: pairs of colliders that no world can have are refused.

#include "math/archive.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Colliders in the order of adding, the floor first: an arm of two links on the floor, two boxes
/// beside each other on a slab.
enum Number : std::uint32_t { floor = 0, base, arm, left, right, slab, wall };

struct Scene {
  Scene() : world(newton(true), 0.01) {
    scene::Entity two = prototype("two", at(2, 0, 0.05), true,
                                  {link("base", cube, 1), link("arm", cube, 1, at(0, 0, 0.1))});
    two.joints = {joint(scene::JointType::revolute, {0, 0, 1}, at(0, 0, 0.05), at(0, 0, -0.05))};
    world.add(two);
    world.add(loose(at(0, 0, 0.15), cube, 1));
    world.add(loose(at(0.2, 0, 0.15), cube, 1));
    world.add(standing(at(0, 0, 0.05), scene::Box{{1, 1, 0.1}}));
    world.add(standing(at(5, 0, 0.05), cube));
    run(world, 0.1, 0.01);
    auto archive = math::Archive::writer(bytes, &places);
    archive("world", world);
  }

  /// Position of the pair of two colliders in the bytes.
  std::size_t place_of(Number a, Number b) const {
    for (const auto& [offset, path] : places) {
      if (path.find("/pairs/") == std::string::npos || !path.ends_with("/a")) continue;
      if (number_at(offset) == a && number_at(offset + 4) == b) return offset;
    }
    ADD_FAILURE() << a << " and " << b << " are no pair";
    return 0;
  }
  std::uint32_t number_at(std::size_t offset) const {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
  }
  /// The error when a pair is read as another one; empty: there is none.
  std::string error_with(std::size_t place, std::uint32_t a, std::uint32_t b) {
    std::vector<std::byte> changed = bytes;
    std::memcpy(changed.data() + place, &a, sizeof a);
    std::memcpy(changed.data() + place + sizeof a, &b, sizeof b);
    return error_of(changed);
  }
  std::string error_of(const std::vector<std::byte>& changed) {
    try {
      auto archive = math::Archive::reader(changed);
      archive("world", world);
      return {};
    } catch (const math::ArchiveError& error) {
      return error.what();
    }
  }

  World world;
  std::vector<std::byte> bytes;
  std::vector<math::Archive::Place> places;
};

TEST(Archive, RefusesPairsThatNoWorldHas) {
  Scene scene;
  const std::size_t place = scene.place_of(left, slab);
  const auto error = [&](std::uint32_t a, std::uint32_t b) {
    return scene.error_with(place, a, b);
  };
  EXPECT_EQ(error(left, slab), "");
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << ", not: " << part;
  };
  has(error(base, arm), "touches its own entity");
  has(error(left, left), "touches its own entity");
  has(error(slab, left), "has its colliders in another order");
  has(error(slab, wall), "is of two colliders that stand");
  has(error(right, slab), "has a pair twice");
  has(error(base, floor), "has a pair twice");
  has(error(floor, slab), "touches what is not there");
  has(error(slab, floor), "is of two colliders that stand");
  has(error(left, wall + 1), "is beyond its list");
  has(error(~0U, slab), "is beyond its list");
  EXPECT_EQ(scene.error_of(scene.bytes), "") << "it can still be read into";
  scene.world.step();
}

/// A quaternion of length 1e-300 is finite, and the next substep would not be.
TEST(Archive, RefusesTurnsThatAreNoRotations) {
  Scene scene;
  int turns = 0, trees = 0;
  for (std::size_t i = 0; i + 1 < scene.places.size(); ++i) {
    const auto& [offset, path] = scene.places[i];
    const bool has_place = scene.places[i + 1].offset > offset;  // what stands has none
    const bool is_turn = path.ends_with("/turn"), is_tree = path.ends_with("/q") && has_place;
    if (!is_turn && !is_tree) continue;
    std::array<double, 4> none{1e-300, 1e-300, 1e-300, 1e-300};
    std::vector<std::byte> changed = scene.bytes;
    const std::size_t place =
        offset + (is_tree ? 3 * sizeof(double) : 0);  // behind the root's position
    ASSERT_LE(place + sizeof none, changed.size());
    std::memcpy(changed.data() + place, none.data(), sizeof none);
    const std::string error = scene.error_of(changed);
    EXPECT_NE(error.find("rotation"), std::string::npos) << path << ": " << error;
    ++(is_turn ? turns : trees);
  }
  EXPECT_EQ(turns, 6);
  EXPECT_EQ(trees, 3);
  EXPECT_EQ(scene.error_of(scene.bytes), "");
}

}  // namespace
}  // namespace ziggurat::physics
