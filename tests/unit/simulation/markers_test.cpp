// SPDX-License-Identifier: MIT
// Markers of robots: shown for one tick, and no part of the state that matters.

#include <gtest/gtest.h>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::SmallScene;

const std::string painter = R"(<foot-bot id="r"><body/><controller config="c"/></foot-bot>)";
const world::Marker ring{.robot = 0, .shape = world::Marker::Shape::ring, .radius = 1};

SmallScene scene() {
  return {R"(<debug implementation="default"/>)", "", painter, testing::ground};
}

TEST(Markers, AreOfRobotsWhoseControllerHasTheActuator) {
  EXPECT_TRUE(scene().run().layout().robots[0].draws_markers);
  EXPECT_FALSE(SmallScene({"", "", painter}).run().layout().robots[0].draws_markers);
}

TEST(Markers, AreShownForOneTick) {
  Simulation simulation = scene().run();
  simulation.step();
  EXPECT_TRUE(simulation.state().markers.empty());
  simulation.commands().markers = {ring};
  simulation.step();
  ASSERT_EQ(simulation.state().markers.size(), 1U);
  EXPECT_EQ(simulation.state().markers[0].radius, 1);
  EXPECT_TRUE(simulation.commands().markers.empty());
  simulation.step();
  EXPECT_TRUE(simulation.state().markers.empty());
}

TEST(Markers, HaveNoEffectOnTheHash) {
  Simulation plain = scene().run(), drawn = scene().run();
  for (int i = 0; i < 5; ++i) {
    drawn.commands().markers.assign(1000, ring);
    plain.step();
    drawn.step();
    EXPECT_EQ(plain.hash(), drawn.hash()) << i;
  }
}

TEST(Markers, StayInASnapshotAndGoWithAReset) {
  const scene::Scene read = scene().read();
  Simulation drawn(read, {1}), restored(read, {1});
  drawn.commands().markers = {ring};
  drawn.step();
  Snapshot snapshot = drawn.snapshot();
  snapshot.is_checked = false;  // as if it was read from a file
  restored.restore(read, snapshot);
  ASSERT_EQ(restored.state().markers.size(), 1U);
  EXPECT_EQ(restored.state().markers[0].shape, ring.shape);
  restored.reset(read, {1});
  EXPECT_TRUE(restored.state().markers.empty());
}

}  // namespace
}  // namespace ziggurat::simulation
