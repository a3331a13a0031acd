// SPDX-License-Identifier: MIT
// Bodies of each shape at rest, rolling and turning.

#include <gtest/gtest.h>

#include <cmath>

#include "../bench_scene.h"
#include "physics/collision/shape.h"
#include "physics/placement.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Quaternion;
using math::Vector3;

scene::Hull hull(const std::vector<Vector3>& points) {
  return std::get<scene::Hull>(scene::make_hull(points));
}

scene::Hull hull_of_box(const Vector3& size) {
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                        i & 4 ? size.z() : 0);
  }
  return hull(points);
}

/// A right triangle a x c, extruded by b.
scene::Hull ramp(double a, double b, double c) {
  return hull({{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {a, b, 0}, {0, 0, c}, {0, b, c}});
}

world::State after(World& world, int substeps) {
  for (int i = 0; i < substeps; ++i) world.step();
  return state_of(world);
}

TEST(Shape, ACapsuleWithoutCylinderIsASphere) {
  const Vector3 capsule = inertia(scene::Capsule{0.1, 0.2}, 3);
  EXPECT_NEAR((capsule - inertia(scene::Sphere{0.1}, 3)).norm(), 0, 1e-15);
  // A long one is nearly a rod: m l^2 / 12.
  const Vector3 rod = inertia(scene::Capsule{1e-4, 1}, 3);
  EXPECT_NEAR(rod.x(), 3.0 / 12, 1e-3);
}

TEST(Shape, AHullOfABoxFallsAndRestsAsTheBox) {
  const Vector3 size(0.1, 0.06, 0.04);
  EXPECT_NEAR((shape_frame(hull_of_box(size)).position - Vector3(0, 0, 0.02)).norm(), 0, 1e-15);
  World world(with_floor(9.8), 0.01);
  world.add(prototype("hull", at(0, 0, 0.05), true, {link("l", hull_of_box(size), 0.3)}));
  world.add(prototype("box", at(1, 0, 0.05), true, {link("l", scene::Box{size}, 0.3)}));
  const world::State state = after(world, 300);
  EXPECT_NEAR(state.origins[0].position.z(), 0, 1e-5);
  EXPECT_NEAR(state.origins[1].position.z(), 0, 1e-5);
  EXPECT_LT(state.links[0].velocity.norm(), 1e-4);
}

/// Tests of a hull whose axes are turned against its link's.
TEST(Shape, ARampSlidesOnAFaceAndKeepsItsFrame) {
  World world(with_floor(9.8), 0.01);
  scene::Entity entity =
      prototype("ramp", at(0, 0, 0), true, {link("l", ramp(0.4, 0.2, 0.16), 0.3)});
  world.add(entity);
  EXPECT_EQ(state_of(world).origins[0].position, Vector3(0, 0, 0));
  const world::State state = after(world, 300);
  EXPECT_LT(state.origins[0].position.norm(), 1e-5);
  EXPECT_LT(state.origins[0].orientation.vec().norm(), 1e-4);
  EXPECT_LT(state.links[0].velocity.norm(), 1e-5);
}

TEST(Shape, AHullTurnsFreelyAboutItsCenterOfMass) {
  World world(with_gravity(0), 1e-3);
  scene::Entity entity =
      prototype("two", at(0, 0, 0), true,
                {link("ramp", ramp(0.4, 0.2, 0.16), 0.3), link("arm", scene::Sphere{0.01}, 1e-3)});
  entity.joints.push_back(
      joint(scene::JointType::revolute, Vector3::UnitY(), at(0.4 / 3, 0.1, 0.16 / 3), {}));
  world.add(entity);
  world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e-4);
  world.set_target(world.joint(0, 0), 10);
  const world::State state = after(world, 500);
  // Whatever turns inside, the common centre of mass stays.
  const Vector3 ramp_center = state.links[0].pose * Vector3(0.4 / 3, 0.1, 0.16 / 3);
  const Vector3 arm_center = state.links[1].pose * Vector3(0, 0, 0.01);
  const Vector3 before = (0.3 * Vector3(0.4 / 3, 0.1, 0.16 / 3) +
                          1e-3 * (Vector3(0.4 / 3, 0.1, 0.16 / 3) + Vector3(0, 0, 0.01))) /
                         0.301;
  EXPECT_NEAR(((0.3 * ramp_center + 1e-3 * arm_center) / 0.301 - before).norm(), 0, 1e-6);
  EXPECT_GT(state.links[1].angular_velocity.norm(), 1);
}

/// Distance down a slope after 0.5 s, from rest, for shapes that roll about y.
double rolled(const scene::Geometry& shape, const Quaternion& lying, double radius) {
  const double angle = 10 * EIGEN_PI / 180;
  World world(with_gravity(9.8), 1e-3);
  const Quaternion tilt = about({0, 1, 0}, angle);
  world.add(
      prototype("slope", {{0, 0, -0.1}, tilt}, false, {link("l", scene::Box{{4, 1, 0.1}}, 1)}));
  const Vector3 normal = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  const Vector3 center = Vector3(0, 0, -0.1) + normal * (0.1 + radius);
  const Quaternion orientation = tilt * lying;
  scene::Entity body =
      prototype("body", {center - orientation * shape_frame(shape).position, orientation}, true,
                {link("l", shape, 0.2)});
  world.add(body);
  const world::State state = after(world, 500);
  return (state.links[1].pose * shape_frame(shape).position - center).dot(downhill);
}

TEST(Rolling, IsAsFastAsTheMomentOfInertiaSays) {
  const double g = 9.8 * std::sin(10 * EIGEN_PI / 180);
  const double r = 0.05;
  const auto expected = [&](double inertia) {
    return 0.5 * 0.25 * g / (1 + inertia / (0.2 * r * r));
  };
  const scene::Sphere ball{r};
  EXPECT_NEAR(rolled(ball, Quaternion::Identity(), r), expected(inertia(ball, 0.2).x()), 1e-3);
  const scene::Capsule capsule{r, 0.3};
  EXPECT_NEAR(rolled(capsule, about({1, 0, 0}, EIGEN_PI / 2), r),
              expected(inertia(capsule, 0.2).z()), 1e-3);
}

TEST(Rest, ASphereEntityStopsAndSleeps) {
  World world(with_floor(9.8), 0.01);
  scene::Entity ball =
      single(scene::EntityKind::sphere, at(0, 0, 0.02), true, scene::Sphere{0.02}, 0.1);
  world.add(ball);
  const world::State state = after(world, 400);
  EXPECT_NEAR(state.origins[0].position.z(), 0, 2e-5);
  EXPECT_EQ(state.links[0].velocity, Vector3(0, 0, 0));  // asleep
}

TEST(Rest, ACapsuleLiesAtItsRadiusAndStandsOnNothing) {
  World world(with_floor(9.8), 0.01);
  const scene::Capsule capsule{0.02, 0.1};
  world.add(prototype("lying", {{0, 0, 0.05}, about({1, 0, 0}, EIGEN_PI / 2)}, true,
                      {link("l", capsule, 0.1)}));
  const world::State state = after(world, 400);
  EXPECT_NEAR((state.origins[0] * Vector3(0, 0, 0.05)).z(), 0.02, 5e-5);
}

TEST(Rest, ShapesLieOnEachOther) {
  // A box on two parallel capsules on a hull: none sinks into another.
  World world(with_floor(9.8), 0.01);
  world.add(prototype("base", at(0, 0, 0), true, {link("l", hull_of_box({0.4, 0.4, 0.05}), 2)}));
  const Quaternion lying = about({1, 0, 0}, EIGEN_PI / 2);
  for (const double x : {-0.1, 0.1}) {
    const scene::Capsule capsule{0.03, 0.3};
    world.add(prototype("capsule", {Vector3(x, 0, 0.08) - lying * Vector3(0, 0, 0.15), lying}, true,
                        {link("l", capsule, 0.3)}));
  }
  world.add(
      single(scene::EntityKind::box, at(0, 0, 0.11), true, scene::Box{{0.3, 0.2, 0.02}}, 0.5));
  const world::State state = after(world, 300);
  EXPECT_NEAR(state.origins[0].position.z(), 0, 5e-5);
  for (const std::size_t i : {1, 2}) {
    EXPECT_NEAR((state.origins[i] * Vector3(0, 0, 0.15)).z(), 0.08, 2e-4);
  }
  EXPECT_NEAR(state.origins[3].position.z(), 0.11, 3e-4);
}

TEST(Placement, KnowsAllShapes) {
  Placement placement;
  placement.add(prototype("pill", at(0, 0, 0), true, {link("l", scene::Capsule{0.1, 0.4}, 1)}));
  const auto overlapped = [&](const scene::Geometry& shape, double x, double z) {
    return !placement.overlapped_by(prototype("p", at(x, 0, z), true, {link("l", shape, 1)}))
                .empty();
  };
  const scene::Hull cube = hull_of_box({0.1, 0.1, 0.1});
  EXPECT_TRUE(overlapped(cube, 0.149, 0.1));
  EXPECT_FALSE(overlapped(cube, 0.151, 0.1));
  EXPECT_FALSE(overlapped(cube, 0, 0.401));
  EXPECT_TRUE(overlapped(cube, 0, 0.399));
  EXPECT_TRUE(overlapped(scene::Capsule{0.1, 0.4}, 0.199, 0));
  EXPECT_FALSE(overlapped(scene::Capsule{0.1, 0.4}, 0.201, 0));
  EXPECT_TRUE(overlapped(scene::Sphere{0.05}, 0.149, 0.15));
  EXPECT_FALSE(overlapped(scene::Sphere{0.05}, 0.151, 0.15));
}

}  // namespace
}  // namespace ziggurat::physics
