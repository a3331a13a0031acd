// SPDX-License-Identifier: MIT
// Magnetism acting on bodies in Bullet.

#include <gtest/gtest.h>

#include "../long_runs.h"
#include "bench_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Vector3;

scene::Physics magnetic(double g) {
  scene::Physics physics = with_gravity(g);
  physics.magnetism = scene::Magnetism{};
  return physics;
}

/// A stigmergic block: a 55 mm cube with eight spherical magnets on spherical joints.
scene::Entity block(const std::string& id, const Pose& pose, bool movable = true) {
  scene::Entity entity =
      prototype(id, pose, movable, {link("base", scene::Box{{0.055, 0.055, 0.055}}, 0.102)});
  int index = 1;
  for (const double z : {0.005, 0.05}) {
    for (const double x : {-0.0225, 0.0225}) {
      for (const double y : {-0.0225, 0.0225}) {
        entity.links.push_back(link("sphere" + std::to_string(index), scene::Sphere{0.003}, 0.001));
        scene::Joint ball = joint(scene::JointType::spherical, Vector3::UnitZ(),
                                  {{x, y, z}, math::Quaternion::Identity()},
                                  {{0, 0, 0.003}, math::Quaternion::Identity()});
        ball.child = static_cast<std::size_t>(index);
        entity.joints.push_back(ball);
        entity.devices.magnets.push_back(magnet(index, {0, 0, 0.003}, {0, 0, 65}));
        ++index;
      }
    }
  }
  return entity;
}

TEST(Magnets, TwoDipolesAttractAsTheDialectMeasured) {
  // Dialect A.6: 65-unit collinear dipoles at 5 cm, one fixed, the other 1 g, 20 substeps of 1 ms.
  World world(magnetic(0), 0.001);
  for (const double x : {0.0, 0.05}) {
    scene::Entity body = prototype("dipole", {{x, 0, 0}, math::Quaternion::Identity()}, x != 0,
                                   {link("base", scene::Sphere{0.003}, 0.001)});
    body.devices.magnets.push_back(magnet(0, {0, 0, 0.003}, {65, 0, 0}));
    world.add(body);
  }
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_NEAR(0.05 - state_of(world).origins[1].position.x(), 0.605e-3, 5e-6);
}

TEST(Magnets, OffsetsTurnWithTheLink) {
  // The magnet is at the end of an arm along y, so the force acts there.
  World world(magnetic(0), 0.001);
  scene::Entity fixed = prototype("fixed", {{0, 0.2, 0.03}, math::Quaternion::Identity()}, false,
                                  {link("base", scene::Sphere{0.003}, 0.001)});
  fixed.devices.magnets.push_back(magnet(0, {0, 0, 0.003}, {1000, 0, 0}));
  world.add(fixed);
  scene::Entity arm = prototype("arm", {{0.02, 0, 0.023}, about({0, 0, 1}, EIGEN_PI / 2)}, true,
                                {link("base", scene::Box{{0.4, 0.02, 0.02}}, 0.1)});
  arm.devices.magnets.push_back(magnet(0, {0.2, 0, 0.01}, {0, -1000, 0}));  // +x in the world
  world.add(arm);
  for (int i = 0; i < 5; ++i) world.step();
  const world::LinkState state = state_of(world).links[1];
  EXPECT_LT(state.velocity.x() + state.angular_velocity.cross(Vector3(0, 0.2, 0)).x(), 0);
  EXPECT_GT(state.angular_velocity.z(), 0);  // the end at +y goes to -x
}

TEST(Magnets, AnchoredAtTheOriginAct) {
  World world(magnetic(0), 0.001);
  for (const double x : {0.0, 0.05}) {
    scene::Entity body = prototype("dipole", {{x, 0, 0}, math::Quaternion::Identity()}, x != 0,
                                   {link("base", scene::Sphere{0.003}, 0.001)});
    body.devices.magnets.push_back(magnet(scene::Anchor::origin, {0, 0, 0.003}, {65, 0, 0}));
    world.add(body);
  }
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_NEAR(0.05 - state_of(world).origins[1].position.x(), 0.605e-3, 5e-6);
}

TEST(Blocks, AllLinksStandWhereTheyAreAssembled) {
  World world(magnetic(0), 0.01);
  world.add(block("block", {{1, 2, 3}, about({1, 1, 0}, 0.5)}));
  const world::State before = state_of(world);
  ASSERT_EQ(before.links.size(), 9u);
  for (int i = 0; i < 10; ++i) world.step();
  const world::State after = state_of(world);
  const Pose moved = after.origins[0] * math::inverse(before.origins[0]);
  for (std::size_t i = 1; i < 9; ++i) {
    const Vector3 centre_before = before.links[i].pose * Vector3(0, 0, 0.003);
    const Vector3 centre_after = after.links[i].pose * Vector3(0, 0, 0.003);
    EXPECT_LT((moved * centre_before - centre_after).norm(), 1e-9) << i;
  }
}

TEST(Blocks, AttractFromOneCentimetreAndComeToRest) {
  // The report's section 3.1, on a floor of low friction at 10 ms.
  scene::Physics physics = magnetic(9.8);
  physics.floor = scene::Floor{};
  physics.floor->surface.friction = 0.02;
  physics.magnetism->max_distance = 0.1;
  World world(physics, 0.01);
  world.add(block("one", {{0, 0, 0}, math::Quaternion::Identity()}));
  world.add(block("two", {{0.065, 0, 0}, math::Quaternion::Identity()}));
  for (int i = 0; i < 500; ++i) world.step();
  const world::State state = state_of(world);
  const Vector3 between = state.origins[1].position - state.origins[0].position;
  EXPECT_NEAR(between.x(), 0.055, 5e-4);
  EXPECT_LT(state.links[0].velocity.norm(), 1e-3);
  EXPECT_LT(state.links[9].velocity.norm(), 1e-3);
}

TEST(Blocks, ThirtyTwoTouchingBlocksStayAtRest) {
  scene::Physics physics = magnetic(9.8);
  physics.floor = scene::Floor{};
  physics.magnetism->max_distance = 0.05;
  World world(physics, 0.01);
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        world.add(
            block("block", {{0.055 * x, 0.055 * y, 0.055 * z}, math::Quaternion::Identity()}));
      }
    }
  }
  const world::State start = state_of(world);
  for (int i = 0; i < (long_runs::is_slow ? 30 : 300); ++i) world.step();
  const world::State end = state_of(world);
  for (std::size_t i = 0; i < 32; ++i) {
    EXPECT_LT((end.origins[i].position - start.origins[i].position).norm(), 1e-3) << i;
    EXPECT_LT(end.links[9 * i].velocity.norm(), 5e-3) << i;
  }
}

TEST(Electromagnet, LiftsHoldsAndReleases) {
  // A lift with four electromagnets over a block, as the robot's end effector has.
  scene::Physics physics = magnetic(9.8);
  physics.floor = scene::Floor{};
  physics.magnetism->max_distance = 0.1;
  World world(physics, 0.01);
  world.add(block("block", {}));
  scene::Entity lift = prototype("lift", {{0, 0, 0.2}, math::Quaternion::Identity()}, false,
                                 {link("mast", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                  link("plate", scene::Box{{0.06, 0.06, 0.01}}, 0.1)});
  lift.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitZ(),
                              {{0, 0, -0.2 + 0.06}, math::Quaternion::Identity()}, {}));
  for (const double x : {-0.0225, 0.0225}) {
    for (const double y : {-0.0225, 0.0225}) {
      scene::Magnet electromagnet = magnet(1, {x, y, 0.005}, {0, 0, 100});
      electromagnet.active_field = {0, 0, 100};
      lift.devices.magnets.push_back(electromagnet);
    }
  }
  world.add(lift);
  const JointIndex rail = world.joint(1, 0);
  world.add_motor(rail, scene::JointMode::position, 0.4);
  const auto set_current = [&](double current) {
    std::vector<double> currents(12, 0.0);  // eight magnets of the block, then the lift's four
    std::fill(currents.begin() + 8, currents.end(), current);
    world.set_currents(currents);
  };
  set_current(1);
  world.set_target(rail, -0.004);  // 1 mm over the block
  for (int i = 0; i < 100; ++i) world.step();
  double fastest = 0;
  for (int i = 0; i < 400; ++i) {
    world.set_target(rail, std::min(-0.004 + 0.0005 * i, 0.05));  // 0.05 m/s
    world.step();
    if (i > 300) fastest = std::max(fastest, state_of(world).links[0].velocity.norm());
  }
  EXPECT_GT(state_of(world).origins[0].position.z(), 0.04) << "lifted";
  EXPECT_LT(fastest, 1e-3) << "held without jitter";
  set_current(-1);  // no moment remains
  for (int i = 0; i < 100; ++i) world.step();
  EXPECT_LT(state_of(world).origins[0].position.z(), 0.001) << "let go";
}

}  // namespace
}  // namespace ziggurat::physics
