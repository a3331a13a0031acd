// SPDX-License-Identifier: MIT
// Entities added to and removed from a running world.

#include <gtest/gtest.h>

#include <cmath>

#include "bench_scene.h"
#include "physics/collision/ray.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Vector3;

scene::Entity box_at(const Vector3& position, bool movable = true) {
  return single(scene::EntityKind::box, {position, math::Quaternion::Identity()}, movable, cube, 1);
}

Vector3 position(const World& world, std::size_t entity) {
  return state_of(world).origins[entity].position;
}

/// A pendulum that swings about y on a fixed base in the air.
scene::Entity pendulum(const Vector3& at) {
  scene::Entity entity = prototype(
      "pendulum", {at, math::Quaternion::Identity()}, false,
      {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1), link("bob", scene::Sphere{0.01}, 0.1)});
  entity.joints.push_back(joint(scene::JointType::revolute, Vector3::UnitY(),
                                {{0, 0, 0}, math::Quaternion::Identity()},
                                {{0.1, 0, 0.01}, math::Quaternion::Identity()}));
  return entity;
}

TEST(AddEntity, TooManyInOnePlaceAreAFault) {
  EXPECT_EQ(
      fault_of_crowd(with_gravity(9.8), 1500),
      "more than 1000000 pairs of bodies are near each other; place fewer bodies in one place");
}

TEST(AddEntity, KeepsItsPoseUntilTheNextStep) {
  World world(with_gravity(9.8), 0.01);
  world.add(box_at({0, 0, 5}));
  for (int i = 0; i < 7; ++i) world.step();
  const Pose pose{{0.1, 0.7, 0.3}, about({1, 2, 3}, 0.7)};
  world.add(single(scene::EntityKind::box, pose, true, cube, 1));
  const world::State state = state_of(world);
  EXPECT_EQ(state.origins[1].position, pose.position);
  EXPECT_EQ(state.origins[1].orientation.coeffs(), pose.orientation.coeffs());
  EXPECT_EQ(state.links[1].velocity, Vector3::Zero());
}

TEST(AddEntity, FallsWithoutAffectingDistantEntities) {
  const double h = 0.01, g = 9.8;
  World world(with_gravity(g), h), alone(with_gravity(g), h);
  for (World* each : {&world, &alone}) {
    each->add(box_at({0, 0, 5}));
    each->add(pendulum({1, 0, 3}));
    for (int i = 0; i < 20; ++i) each->step();
  }
  world.add(box_at({3, 0, 7}));
  for (int n = 1; n <= 40; ++n) {
    world.step();
    alone.step();
    ASSERT_NEAR(position(world, 2).z(), 7 - fall(g, h, n), 1e-12) << "substep " << n;
    ASSERT_EQ(position(world, 0), position(alone, 0));
    ASSERT_EQ(state_of(world).links[2].pose.position, state_of(alone).links[2].pose.position);
  }
}

TEST(AddEntity, ChangesNoBitOfDistantContacts) {
  World world(with_floor(9.8), 0.01), alone(with_floor(9.8), 0.01);
  for (World* each : {&world, &alone}) {
    for (int i = 0; i < 5; ++i) each->add(box_at({0.3 * i, 0, 0.02 + 0.01 * i}));
    for (int i = 0; i < 3; ++i) each->step();
  }
  world.add(box_at({50, 0, 0}));
  for (int i = 0; i < 200; ++i) {
    world.step();
    alone.step();
    for (std::size_t k = 0; k < 5; ++k) {
      ASSERT_EQ(position(world, k), position(alone, k)) << i;
    }
  }
}

TEST(AddEntity, CollidesWithFallingBodies) {
  World world(with_floor(9.8), 0.01);
  world.add(box_at({0, 0, 1}));
  for (int i = 0; i < 5; ++i) world.step();
  world.add(box_at({0, 0, 0}));
  for (int i = 0; i < 300; ++i) world.step();
  EXPECT_NEAR(position(world, 0).z(), 0.1, 1e-4);
}

TEST(AddEntity, OverlapIsTestedAtPresentPoses) {
  World world(with_gravity(9.8), 0.01);
  world.add(box_at({0, 0, 0}, false));
  world.add(box_at({1, 0, 5}));
  const auto overlapped_at = [&](const Vector3& place) {
    const scene::Entity box = box_at(place);
    return world.overlapped_by(box, box.pose);
  };
  EXPECT_EQ(overlapped_at({0.09, 0, 0}), 0u);
  EXPECT_EQ(overlapped_at({0.1, 0, 0}), std::nullopt) << "they touch";
  EXPECT_EQ(overlapped_at({1, 0, 5}), 1u);
  for (int i = 0; i < 100; ++i) world.step();
  EXPECT_EQ(overlapped_at({1, 0, 5}), std::nullopt);
  EXPECT_EQ(overlapped_at(position(world, 1)), 1u);
  world.remove(0);
  EXPECT_EQ(overlapped_at({0, 0, 0}), std::nullopt);
}

TEST(RemoveEntity, WakesAllThatRestsOnItAfterOthersCameAndWent) {
  World world(with_gravity(9.8), 0.01);
  world.add(single(scene::EntityKind::box, {}, false, scene::Box{{1, 1, 0.1}}, 1));
  for (int i = 0; i < 9; ++i) world.add(box_at({0.105 * (i - 4), 0, 0.1}));
  for (int i = 0; i < 100; ++i) world.step();
  for (const std::size_t gone : {5, 9, 1, 6}) world.remove(gone);  // within its list, both ends
  world.add(box_at({0, 0, 0.11}));
  for (int i = 0; i < 100; ++i) world.step();
  for (const std::size_t rests : {2, 3, 4, 7, 8, 10}) {
    ASSERT_NEAR(position(world, rests).z(), 0.1, 1e-4) << rests;
  }
  world.remove(0);
  for (int i = 0; i < 20; ++i) world.step();
  for (const std::size_t falls : {2, 3, 4, 7, 8, 10}) {
    EXPECT_NEAR(position(world, falls).z(), 0.1 - fall(9.8, 0.01, 20), 1e-3) << falls;
  }
}

TEST(RemoveEntity, WakesBodiesThatSleptOnIt) {
  World world(with_floor(9.8), 0.01);
  world.add(box_at({0, 0, 0}, false));
  world.add(box_at({0, 0, 0.1}));
  for (int i = 0; i < 300; ++i) world.step();
  ASSERT_NEAR(position(world, 1).z(), 0.1, 1e-5);
  world.remove(0);
  for (int i = 0; i < 300; ++i) world.step();
  EXPECT_NEAR(position(world, 1).z(), 0, 1e-4);
}

TEST(MoveEntity, WakesBodiesThatSleptOnIt) {
  World world(with_floor(9.8), 0.01);
  world.add(box_at({0, 0, 0}));
  world.add(box_at({0, 0, 0.1}));
  for (int i = 0; i < 300; ++i) world.step();
  world.move(0, {{2, 0, 0}, math::Quaternion::Identity()});
  for (int i = 0; i < 300; ++i) world.step();
  EXPECT_NEAR(position(world, 1).z(), 0, 1e-4);
}

TEST(RemoveEntity, RemovesItsJointsAndMotorsOnly) {
  World world(with_gravity(9.8), 0.001), alone(with_gravity(9.8), 0.001);
  world.add(pendulum({0, 0, 3}));
  world.add(pendulum({1, 0, 3}));
  alone.add(pendulum({1, 0, 3}));
  const JointIndex first = world.joint(0, 0), second = world.joint(1, 0);
  world.add_motor(first, scene::JointMode::velocity, 1);
  world.set_target(first, 3);
  for (int i = 0; i < 100; ++i) world.step();
  world.remove(0);
  world.set_target(first, 1);
  for (int i = 0; i < 100; ++i) world.step();
  for (int i = 0; i < 200; ++i) alone.step();
  EXPECT_EQ(world.position(first), 0);
  EXPECT_EQ(world.velocity(first), 0);
  EXPECT_NE(world.position(second), 0);
  EXPECT_EQ(world.position(second), alone.position(alone.joint(0, 0)));
}

TEST(RemoveEntity, StopsItsWheels) {
  World world(with_floor(9.8), 0.01);
  scene::Entity robot = box_at({0, 0, 0});
  robot.traction = scene::Traction{10, 1};
  robot.axle_length = 0.1;
  world.add(robot);
  world.add(box_at({1, 0, 0}));
  world.set_velocity(0, 0.2, 0);
  for (int i = 0; i < 50; ++i) world.step();
  EXPECT_NEAR(position(world, 0).x(), 0.1, 1e-3);
  world.remove(0);
  for (int i = 0; i < 50; ++i) world.step();
  EXPECT_NEAR(position(world, 1).x(), 1, 1e-6);
}

TEST(RemoveEntity, RemovesItsMagnetsAndKeepsCurrentsOfOthers) {
  // Three dipoles in a row: the middle one is fixed and attracts according to its current.
  scene::Physics physics = with_gravity(0);
  physics.magnetism = scene::Magnetism{};
  World world(physics, 0.001);
  for (const double x : {-0.05, 0.0, 0.05}) {
    scene::Entity body = prototype("dipole", {{x, 0, 0}, math::Quaternion::Identity()}, x > 0,
                                   {link("base", scene::Sphere{0.003}, 0.001)});
    scene::Magnet magnet;
    magnet.anchor.link = 0;
    magnet.offset = {0, 0, 0.003};
    magnet.passive_field = x == 0 ? Vector3::Zero() : Vector3(65, 0, 0);
    magnet.active_field = x == 0 ? Vector3(65, 0, 0) : Vector3::Zero();
    body.devices.magnets.push_back(magnet);
    world.add(body);
  }
  world.remove(0);
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_EQ(position(world, 2).x(), 0.05) << "no dipole attracts it";
  const double currents[] = {0, 1, 0};
  world.set_currents(currents);
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_NEAR(0.05 - position(world, 2).x(), 0.605e-3, 5e-6) << "dialect A.6";
  world.remove(1);
  const double before = position(world, 2).x();
  const double speed = state_of(world).links[2].velocity.x();
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_NEAR(position(world, 2).x(), before + 0.02 * speed, 1e-9)
      << "no dipole attracts it any more";
}

TEST(RemoveEntity, IsIgnoredByRays) {
  World world(with_gravity(0), 0.01);
  Rays rays{with_gravity(0)};
  for (const double x : {1.0, 2.0}) {
    world.add(box_at({x, 0, 0}));
    rays.add(box_at({x, 0, 0}));
  }
  const RayQuery query{{0, 0, 0.05}, {5, 0, 0.05}, {}, false};
  rays.update(state_of(world));
  EXPECT_EQ(rays.cast(query)->entity, 0u);
  rays.remove(0);
  rays.update(state_of(world));
  EXPECT_EQ(rays.cast(query)->entity, 1u);
  Candidates near;
  rays.find({0, -1, 0}, {5, 1, 1}, {}, near);
  EXPECT_EQ(near.colliders.size(), 1u);
}

TEST(AddAndRemoveEntity, AThousandTimesLeavesTheWorldUnchanged) {
  World world(with_floor(9.8), 0.01);
  world.add(box_at({0, 0, 0}));
  for (std::size_t n = 1; n <= 1000; ++n) {
    world.add(n % 2 == 0 ? box_at({0, 0, 0.1}) : pendulum({0.3, 0, 1}));
    world.step();
    world.remove(n);
  }
  for (int i = 0; i < 100; ++i) world.step();
  EXPECT_NEAR(position(world, 0).z(), 0, 1e-4);
  EXPECT_NEAR(world.energy(), 9.8 * 0.05, 1e-3) << "one box remains";
}

}  // namespace
}  // namespace ziggurat::physics
