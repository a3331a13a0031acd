// SPDX-License-Identifier: MIT
#include "supervision/world.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "scene/reader.h"

namespace ziggurat::supervision {
namespace {

/// A box at one half of a strip, and a box that is placed once, anywhere on the strip: about every
/// second seed does not fit.
scene::OpenScene narrow_scene() {
  const std::string box = R"(size="1,1,1" movable="true" mass="1")";
  auto read = scene::read_text(
      R"(<argos><framework><experiment ticks_per_second="10" random_seed="1"/></framework>)"
      R"(<controllers/><arena size="9,9,9"><box id="fixed" )" +
          box +
          R"(><body position="1,0,0"/></box><distribute><position method="uniform" )"
          R"(min="-2,0,0" max="2,0,0"/><orientation method="constant" values="0,0,0"/>)"
          R"(<entity quantity="1" max_trials="1"><box id="free" )" +
          box +
          R"(/></entity></distribute></arena><physics_engines><dynamics3d id="d"/>)"
          R"(</physics_engines><media/></argos>)",
      "narrow.argos");
  for (const auto& problem : read.problems) ADD_FAILURE() << scene::to_string(problem);
  return {std::move(read.scene), std::move(read.additions)};
}

/// The first seed from 1 on with which the scene fits, or does not.
std::uint64_t seed_that_fits(bool fits) {
  for (std::uint64_t seed = 1;; ++seed) {
    bool did_fit = true;
    try {
      const World world("narrow.argos", narrow_scene(), seed);
    } catch (const scene::SceneError&) {
      did_fit = false;
    }
    if (did_fit == fits) return seed;
  }
}

TEST(World, ARefusedResetChangesNothing) {
  const std::uint64_t good = seed_that_fits(true);
  World world("narrow.argos", narrow_scene(), good);
  for (int i = 0; i < 3; ++i) world.simulation.step();
  const std::uint64_t hash = world.simulation.hash();
  EXPECT_THROW(world.reset(seed_that_fits(false)), scene::SceneError);
  EXPECT_EQ(world.seed, good);
  EXPECT_EQ(world.simulation.state().tick, 3U);
  EXPECT_EQ(world.simulation.hash(), hash);
}

TEST(World, AResetStartsAgainWithTheNewSeed) {
  const std::uint64_t good = seed_that_fits(true);
  World world("narrow.argos", narrow_scene(), good);
  const std::uint64_t first = world.simulation.hash();
  world.simulation.step();
  world.reset(good);
  EXPECT_EQ(world.simulation.hash(), first);
  EXPECT_EQ(world.simulation.entities().size(), 2U);
}

}  // namespace
}  // namespace ziggurat::supervision
