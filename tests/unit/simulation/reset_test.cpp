// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::gravity;
using testing::robot;
using testing::SmallScene;

const std::string falling_box =
    R"(<box id="b" size=".1,.1,.1" movable="true" mass="1"><body position="0,0,5"/></box>)";
const std::string pendulum =
    R"(<prototype id="p" movable="false"><body position="1,0,2"/><links ref="base">)"
    R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)"
    R"(<link id="arm" geometry="box" size=".5,.1,.1" mass="1"/></links><joints>)"
    R"(<joint id="hinge" type="revolute" axis="0,1,0"><parent link="base" position="0,0,0"/>)"
    R"(<child link="arm" position="-.25,0,0"/></joint></joints></prototype>)";

TEST(Reset, IsLikeANewSimulation) {
  const SmallScene small{"", "", falling_box + pendulum + robot("r", "0,1,1", ""), gravity};
  const scene::Scene scene = small.read();
  Simulation used(scene, {1}), fresh(scene, {1});
  const world::Layout* layout = &used.layout();
  for (int i = 0; i < 5; ++i) used.step();
  ASSERT_NE(used.hash(), fresh.hash());
  used.reset(scene, {1});
  EXPECT_EQ(&used.layout(), layout) << "others keep references to it";
  EXPECT_EQ(used.state().tick, 0U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(used.hash(), fresh.hash()) << "tick " << i;
    used.step();
    fresh.step();
  }
}

TEST(Move, PutsABodyToRestFromWhereItFalls) {
  Simulation simulation(SmallScene{"", "", falling_box, gravity}.read(), {1});
  for (int i = 0; i < 4; ++i) simulation.step();
  simulation.move(0, {math::Vector3(1, 2, 3), math::Quaternion::Identity()});
  EXPECT_EQ(simulation.state().links[0].pose.position, math::Vector3(1, 2, 3));
  EXPECT_EQ(simulation.state().links[0].velocity, math::Vector3::Zero());
  simulation.step();
  const math::Vector3 fallen(1, 2, 3 - 10 * 0.1 * 0.1 / 2);
  EXPECT_LT((simulation.state().links[0].pose.position - fallen).norm(), 1e-9);
}

TEST(Move, AssemblesJointsAndCarriesWhatIsWelded) {
  Simulation simulation(SmallScene{"", "", pendulum, gravity}.read(), {1});
  const world::State placed = simulation.state();
  for (int i = 0; i < 4; ++i) simulation.step();
  ASSERT_GT((simulation.state().links[1].pose.position - placed.links[1].pose.position).norm(),
            0.1);
  const math::Vector3 shift(0, 3, 1);
  simulation.move(0, {placed.origins[0].position + shift, math::Quaternion::Identity()});
  for (std::size_t i = 0; i < 2; ++i) {
    const math::Vector3 due = placed.links[i].pose.position + shift;
    EXPECT_LT((simulation.state().links[i].pose.position - due).norm(), 1e-12) << i;
  }
  EXPECT_LT((simulation.state().origins[0].position - placed.origins[0].position - shift).norm(),
            1e-12);
}

}  // namespace
}  // namespace ziggurat::simulation
