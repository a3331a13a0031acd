// SPDX-License-Identifier: MIT
#include "physics/collision/ray.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "../bench_scene.h"

namespace ziggurat::physics {
namespace {

using math::Vector3;

scene::Entity solid(const scene::Geometry& geometry, const math::Pose& pose) {
  return testing::prototype("e", pose, false, {testing::link("l", geometry, 1)});
}

/// Rays among entities of one link each, at their poses.
Rays rays_among(const std::vector<scene::Entity>& entities, bool floor = false) {
  scene::Physics physics;
  if (floor) physics.floor = scene::Floor{};
  Rays rays(physics);
  world::State state;
  for (const scene::Entity& entity : entities) {
    rays.add(entity);
    state.links.push_back({entity.pose});
  }
  rays.update(state);
  return rays;
}

std::optional<double> distance(const Rays& rays, const Vector3& start, const Vector3& end,
                               bool floor = false) {
  const auto hit = rays.cast({start, end, {}, floor});
  return hit ? std::optional(hit->distance) : std::nullopt;
}

TEST(Ray, HitsASphereAtTheClosedFormDistance) {
  const Rays rays = rays_among({solid(scene::Sphere{0.25}, {{1.5, 0, 0}, {1, 0, 0, 0}})});
  EXPECT_DOUBLE_EQ(*distance(rays, {0.02, 0, 0.25}, {3, 0, 0.25}), 1.23);
  const double height = 0.2;  // above the centre
  EXPECT_NEAR(*distance(rays, {0, 0, 0.25 + height}, {3, 0, 0.25 + height}),
              1.5 - std::sqrt(0.25 * 0.25 - height * height), 1e-12);
  EXPECT_FALSE(distance(rays, {0, 0, 0.51}, {3, 0, 0.51}));
}

TEST(Ray, HitsATurnedBoxAtTheClosedFormDistance) {
  const Rays rays = rays_among(
      {solid(scene::Box{{0.2, 0.2, 1}}, {{1, 0, 0}, testing::about({0, 0, 1}, M_PI / 4)})});
  EXPECT_NEAR(*distance(rays, {0, 0, 0.5}, {2, 0, 0.5}), 1 - 0.1 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(*distance(rays, {0, 0.05, 0.5}, {2, 0.05, 0.5}), 1 - 0.1 * std::sqrt(2.0) + 0.05,
              1e-12);
  EXPECT_FALSE(distance(rays, {0, 0, -0.001}, {2, 0, -0.001}));  // the frame is at its bottom
  EXPECT_TRUE(distance(rays, {0, 0, 0.999}, {2, 0, 0.999}));
  EXPECT_FALSE(distance(rays, {0, 0, 1.001}, {2, 0, 1.001}));
}

TEST(Ray, HitsACapsuleAtItsSideAndItsBalls) {
  const Rays rays = rays_among({solid(scene::Capsule{0.1, 0.5}, {{1, 0, 0}, {1, 0, 0, 0}})});
  EXPECT_DOUBLE_EQ(*distance(rays, {0, 0, 0.25}, {3, 0, 0.25}), 0.9);
  EXPECT_DOUBLE_EQ(*distance(rays, {1, 0, 2}, {1, 0, -1}), 1.5);
  const double height = 0.06;  // above the middle of the upper ball
  EXPECT_NEAR(*distance(rays, {0, 0, 0.4 + height}, {3, 0, 0.4 + height}),
              1 - std::sqrt(0.01 - height * height), 1e-12);
  EXPECT_FALSE(distance(rays, {0, 0, 0.501}, {3, 0, 0.501}));
  EXPECT_FALSE(distance(rays, {0.92, 0.2, 0.499}, {0.92, -0.2, 0.499}));  // beside the ball's top
}

TEST(Ray, HitsAHullAtItsFaces) {
  const scene::Hull ramp = std::get<scene::Hull>(scene::make_hull(std::vector<Vector3>{
      {0, 0, 0}, {0.4, 0, 0}, {0, 0.2, 0}, {0.4, 0.2, 0}, {0, 0, 0.2}, {0, 0.2, 0.2}}));
  const Rays rays = rays_among({solid(ramp, {{1, -0.1, 0}, {1, 0, 0, 0}})});
  EXPECT_NEAR(*distance(rays, {0, 0, 0.1}, {3, 0, 0.1}), 1, 1e-12);      // the upright face
  EXPECT_NEAR(*distance(rays, {3, 0, 0.1}, {0, 0, 0.1}), 1.8, 1e-12);    // half way up the slope
  EXPECT_NEAR(*distance(rays, {1.1, 0, 1}, {1.1, 0, -1}), 0.85, 1e-12);  // from above
  EXPECT_FALSE(distance(rays, {1.3, 0, 0.06}, {1.3, 0, 1}));
  EXPECT_FALSE(distance(rays, {1.1, 0, 0.1}, {1.11, 0, 0.1}));  // from inside
}

TEST(Ray, HitsACylinderAtSideAndCap) {
  const Rays rays = rays_among({solid(scene::Cylinder{0.1, 0.5}, {{0, 0, 2}, {1, 0, 0, 0}})});
  EXPECT_NEAR(*distance(rays, {1, 0.06, 2.2}, {-1, 0.06, 2.2}), 1 - 0.08, 1e-12);
  EXPECT_NEAR(*distance(rays, {0.05, 0, 4}, {0.05, 0, 0}), 1.5, 1e-12);
  EXPECT_FALSE(distance(rays, {0.08, 0.08, 4}, {0.08, 0.08, 0}));  // a bounding box would be hit
}

TEST(Ray, DoesNotHitASurfaceAtItsEnd) {
  const Rays rays = rays_among({solid(scene::Box{{2, 2, 2}}, {{2, 0, -1}, {1, 0, 0, 0}})});
  EXPECT_FALSE(distance(rays, {0, 0, 0}, {1 - 1e-6, 0, 0}));
  EXPECT_FALSE(distance(rays, {0, 0, 0}, {1, 0, 0}));
  EXPECT_DOUBLE_EQ(*distance(rays, {0, 0, 0}, {1 + 1e-6, 0, 0}), 1);
}

TEST(Ray, IsNotStoppedByTheBodyItStartsIn) {
  const Rays rays = rays_among({solid(scene::Box{{2, 2, 2}}, {{0, 0, -1}, {1, 0, 0, 0}}),
                                solid(scene::Sphere{0.5}, {{3, 0, -0.5}, {1, 0, 0, 0}})});
  const auto hit = rays.cast({{0.5, 0, 0}, {4, 0, 0}, {}, false});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->entity, 1u);
  EXPECT_DOUBLE_EQ(hit->distance, 2);
  EXPECT_FALSE(distance(rays, {1, 0, 0}, {1.9, 0, 0}));  // from the surface outwards
  EXPECT_EQ(*distance(rays, {-1, 0, 0}, {0, 0, 0}), 0);  // from the surface inwards: contact
  EXPECT_EQ(*distance(rays, {-1 + 5e-5, 0, 0}, {0, 0, 0}), 0);
  EXPECT_FALSE(distance(rays, {-1 + 2e-4, 0, 0}, {0, 0, 0}));
}

TEST(Ray, PassesThroughIgnoredEntities) {
  std::vector<scene::Entity> entities;
  for (int i = 0; i < 3; ++i) {
    entities.push_back(solid(scene::Box{{0.1, 1, 1}}, {{1.0 + i, 0, 0}, {1, 0, 0, 0}}));
  }
  const Rays rays = rays_among(entities);
  const std::array<std::size_t, 2> ignored{0, 1};
  const auto hit = rays.cast({{0, 0, 0.5}, {9, 0, 0.5}, ignored, false});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->entity, 2u);
  EXPECT_DOUBLE_EQ(hit->distance, 2.95);
}

TEST(Ray, HitsTheFloorOnlyIfRequestedAndPresent) {
  const Rays rays = rays_among({}, true);
  EXPECT_DOUBLE_EQ(*distance(rays, {0, 0, 3}, {0, 4, -1}, true), 3 * std::sqrt(2.0));
  EXPECT_FALSE(rays.cast({{0, 0, 3}, {0, 4, -1}, {}, true})->entity);
  EXPECT_FALSE(distance(rays, {0, 0, 3}, {0, 4, -1}, false));
  EXPECT_FALSE(distance(rays, {0, 0, -1}, {0, 0, 1}, true));
  EXPECT_FALSE(distance(rays_among({}), {0, 0, 3}, {0, 4, -1}, true));
}

TEST(Ray, HitsMovingBodiesAtTheirPresentPose) {
  const scene::Entity entity = solid(scene::Sphere{0.1}, {});
  Rays rays(scene::Physics{});
  rays.add(entity);
  world::State state;
  state.links.resize(1);
  for (int tick = 0; tick < 50; ++tick) {
    state.links[0].pose.position = {1 + 0.7 * tick, 0, -0.1};
    rays.update(state);
    EXPECT_NEAR(*distance(rays, {0, 0, 0}, {100, 0, 0}), 0.9 + 0.7 * tick, 1e-9);
  }
}

/// Their volumes are infinite: Bullet's tree would write to memory that is not its own.
TEST(Ray, LeavesOutBodiesThatAreFartherThanAnyRay) {
  std::vector<scene::Entity> entities{solid(scene::Sphere{0.1}, {{1, 0, -0.1}, {1, 0, 0, 0}})};
  for (int i = 0; i < 20; ++i) {
    const double far = std::pow(10.0, 31 + 14 * i) * (i % 2 == 0 ? 1 : -1);
    entities.push_back(solid(scene::Sphere{0.1}, {{far, -far, far}, {1, 0, 0, 0}}));
  }
  EXPECT_NEAR(*distance(rays_among(entities), {0, 0, 0}, {100, 0, 0}), 0.9, 1e-9);
}

TEST(Ray, ABodyThatGoesFarAndComesBackIsHit) {
  Rays rays(scene::Physics{});
  rays.add(solid(scene::Sphere{0.1}, {}));
  world::State state;
  state.links.resize(1);
  for (const double x : {1.0, 1e200, 2.0}) {
    state.links[0].pose.position = {x, 0, -0.1};
    rays.update(state);
    const auto hit = distance(rays, {0, 0, 0}, {100, 0, 0});
    ASSERT_EQ(hit.has_value(), x < 100);
    if (!hit) continue;
    EXPECT_NEAR(*hit, x - 0.1, 1e-9);
  }
}

TEST(Ray, FindsTheClosestOfManyLikeALinearSearch) {
  std::vector<scene::Entity> entities;
  for (int i = 0; i < 300; ++i) {
    const Vector3 at(std::sin(i * 1.7) * 5, std::cos(i * 2.3) * 5, std::sin(i * 0.9) * 5);
    entities.push_back(solid(scene::Sphere{0.2}, {at, {1, 0, 0, 0}}));
  }
  const Rays rays = rays_among(entities);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3 start(0, 0, 0),
        end(std::sin(i) * 9, std::cos(i * 1.3) * 9, std::sin(i * 0.7) * 9);
    std::optional<double> closest;
    for (const auto& entity : entities) {
      const auto share = enter(entity.links[0].geometry, start - entity.pose.position,
                               end - entity.pose.position, 1e-4);
      if (share && (!closest || *share < *closest)) closest = share;
    }
    const auto found = distance(rays, start, end);
    ASSERT_EQ(found.has_value(), closest.has_value()) << i;
    if (!found) continue;
    EXPECT_NEAR(*found, *closest * end.norm(), 1e-12);
    ++hits;
  }
  EXPECT_GT(hits, 20);
}

TEST(Ray, GivesTheSameHitAmongTheCollidersOfItsBoundingBox) {
  std::vector<scene::Entity> entities;
  for (int i = 0; i < 3000; ++i) {
    const Vector3 at(std::sin(i * 1.7) * 5, std::cos(i * 2.3) * 5, std::sin(i * 0.9) * 5);
    entities.push_back(solid(scene::Box{{0.3, 0.2, 0.4}}, {at, testing::about({1, 0, 0}, i)}));
  }
  const Rays rays = rays_among(entities);
  Candidates near;
  int hits = 0, few = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3 start(std::sin(i * 2.1) * 5, std::cos(i * 0.3) * 5, std::sin(i * 1.1) * 5);
    const Vector3 end = start + 3 * Vector3(std::sin(i), std::cos(i * 1.3), std::sin(i * 0.7));
    rays.find(start.cwiseMin(end), start.cwiseMax(end), {}, near);
    few += near.are_few;
    const RayQuery ray{start, end, {}, false};
    const auto among_all = rays.cast(ray), among_near = rays.cast(ray, near);
    ASSERT_EQ(among_all.has_value(), among_near.has_value()) << i;
    if (!among_all) continue;
    EXPECT_EQ(among_all->distance, among_near->distance);
    EXPECT_EQ(among_all->entity, among_near->entity);
    ++hits;
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(few, 50) << "among those that were found";
  EXPECT_LT(few, 450) << "the others by themselves";
}

TEST(Ray, HitsBodiesThatMoveByLessThanTheMargin) {
  Rays rays(scene::Physics{});
  rays.add(solid(scene::Box{{0.2, 0.2, 0.2}}, {}));
  world::State state;
  state.links.resize(1);
  for (int tick = 0; tick < 200; ++tick) {
    state.links[0].pose.position = {1 + 1e-4 * tick, 0, 0};
    rays.update(state);
    EXPECT_NEAR(*distance(rays, {0, 0, 0.1}, {3, 0, 0.1}), 0.9 + 1e-4 * tick, 1e-12);
  }
}

}  // namespace
}  // namespace ziggurat::physics
