// SPDX-License-Identifier: MIT
// A substep in which nothing comes or goes allocates nothing.

#include "allocations/allocations.h"

#include <LinearMath/btAlignedAllocator.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "bench_scene.h"

namespace {

std::size_t of_bullet = 0;

void* counted_for_bullet(std::size_t size, int alignment) {
  ++of_bullet;
  const auto step = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}

}  // namespace

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Vector3;

std::size_t allocations() { return ziggurat::testing::allocations() + of_bullet; }

/// Allocations of so many substeps, after as many to settle.
std::size_t allocations_of(World& world, int substeps) {
  world::State state;
  for (int i = 0; i < substeps; ++i) world.step();
  world.read(state);
  const std::size_t before = allocations();
  for (int i = 0; i < substeps; ++i) world.step();
  world.read(state);
  return allocations() - before;
}

scene::Entity arm() {
  scene::Entity entity = prototype(
      "arm", at(1, 0, 0), true,
      {link("base", scene::Box{{0.2, 0.2, 0.1}}, 1), link("arm", scene::Capsule{0.02, 0.2}, 0.1)});
  entity.joints.push_back(
      joint(scene::JointType::revolute, Vector3::UnitY(), at(0, 0, 0.11), at(0, 0, 0.02)));
  entity.links[0].damping = {0.1, 0.2};
  return entity;
}

scene::Entity wheeled() {
  scene::Entity entity =
      prototype("wheeled", at(-1, 0, 0), true,
                {link("base", scene::Cylinder{0.1, 0.1}, 1), link("turret", scene::Sphere{0}, 0)});
  entity.kind = scene::EntityKind::foot_bot;
  entity.links[1].collides = false;
  entity.traction = scene::Traction{15, 150};
  entity.axle_length = 0.1;
  entity.turret = 1;
  return entity;
}

class Allocations : public ::testing::Test {
 protected:
  void SetUp() override { btAlignedAllocSetCustomAligned(counted_for_bullet, std::free); }
  void TearDown() override { btAlignedAllocSetCustomAligned(nullptr, nullptr); }
};

TEST_F(Allocations, AreCounted) {
  const std::size_t before = ziggurat::testing::allocations(), bullet_before = of_bullet;
  World world(with_floor(9.8), 0.01);
  EXPECT_GT(of_bullet, bullet_before);
  EXPECT_GT(ziggurat::testing::allocations(), before);
}

TEST_F(Allocations, OfBodiesAtRestAreNone) {
  World world(with_floor(9.8), 0.01);
  for (int i = 0; i < 3; ++i) {
    world.add(
        single(scene::EntityKind::box, at(0, 0, 0.1 * i), true, scene::Box{{0.1, 0.1, 0.1}}, 1));
  }
  world.add(single(scene::EntityKind::sphere, at(0.3, 0, 0), true, scene::Sphere{0.05}, 1));
  EXPECT_EQ(allocations_of(world, 100), 0u);
}

TEST_F(Allocations, OfAnArmWithAMotorAreNone) {
  World world(with_floor(9.8), 0.01);
  world.add(arm());
  world.add_motor(world.joint(0, 0), scene::JointMode::position, 0.1);
  world.set_target(world.joint(0, 0), 0.5);
  world.watch_contacts(0, 0);
  EXPECT_EQ(allocations_of(world, 100), 0u);
  EXPECT_TRUE(world.take_touch(0, 0).touched);
}

TEST_F(Allocations, OfARobotOnWheelsAreNone) {
  World world(with_floor(9.8), 0.01);
  world.add(wheeled());
  world.set_velocity(0, 0.1, 0.2);
  world.set_turret(0, 0.3);
  EXPECT_EQ(allocations_of(world, 100), 0u);
  EXPECT_NE(world.turret(0), 0);
}

TEST_F(Allocations, OfMagnetsAreNone) {
  for (const bool adaptive : {false, true}) {
    scene::Physics physics = with_floor(9.8);
    physics.magnetism.emplace().adaptive = adaptive;
    World world(physics, 0.01);
    for (int i = 0; i < 3; ++i) {
      scene::Entity entity = prototype("block", at(0.05 * i, 0, 0), true,
                                       {link("base", scene::Box{{0.04, 0.04, 0.04}}, 0.1)});
      entity.devices.magnets = {magnet(0, {0, 0, 0.02}, {0, 0, 1})};
      world.add(entity);
    }
    EXPECT_EQ(allocations_of(world, 100), 0u) << adaptive;
  }
}

TEST_F(Allocations, OfAllShapesInContactAreNone) {
  const scene::Hull hull = std::get<scene::Hull>(scene::make_hull(std::vector<Vector3>{
      {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.1, 0}, {0, 0, 0.1}, {0, 0.1, 0.1}}));
  World world(with_floor(9.8), 0.01);
  world.add(single(scene::EntityKind::box, at(0, 0, 0), false, scene::Box{{2, 2, 0.1}}, 0));
  const scene::Geometry shapes[] = {scene::Box{{0.1, 0.1, 0.1}}, scene::Cylinder{0.05, 0.1},
                                    scene::Sphere{0.05}, scene::Capsule{0.05, 0.2}, hull};
  double x = -0.8;
  for (const scene::Geometry& shape : shapes) {
    world.add(prototype("p", at(x, 0, 0.1), true, {link("base", shape, 0.5)}));
    x += 0.3;
  }
  EXPECT_EQ(allocations_of(world, 200), 0u);
}

}  // namespace
}  // namespace ziggurat::physics
