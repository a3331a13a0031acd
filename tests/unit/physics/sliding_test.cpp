// SPDX-License-Identifier: MIT
// Sliding, rolling and bouncing, against closed forms at many substeps.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

class NewtonAt : public ::testing::TestWithParam<double> {
 protected:
  double h = 1.0 / GetParam();
};
INSTANTIATE_TEST_SUITE_P(Hertz, NewtonAt, ::testing::ValuesIn(long_runs::substep_rates()),
                         long_runs::name_of_rate<::testing::TestParamInfo<double>>);

TEST_P(NewtonAt, ABoxSlidesDownASlopeByTheFormula) {
  const double angle = 0.35, mu = 0.3, seconds = 3;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  World world(newton(), h);
  world.add(standing({-0.5 * up, tilt}, scene::Box{{12, 2, 0.5}}, 1));
  const Vector3 start = -4 * downhill;
  world.add(loose({start, tilt}, cube, 0.1, mu));
  run(world, seconds, h);
  const Pose end = origin(world, 1);
  const double a = earth * (std::sin(angle) - mu * std::cos(angle));
  const double way = (end.position - start).dot(downhill), expected = a * seconds * seconds / 2;
  EXPECT_NEAR(way, expected, 0.001 * expected + 1.02 * a * seconds * h / 2);
  EXPECT_LT(end.orientation.angularDistance(tilt), 1e-3);
  EXPECT_LT(std::abs((end.position - start).dot(up)), 1e-4);
}

TEST_P(NewtonAt, ABoxInATroughRubsOnBothSides) {
  // A trough of two faces at right angles, rolled by a third and inclined.
  const double slope = 0.6, roll = EIGEN_PI / 6, mu = 0.2, seconds = 1;
  const math::Quaternion tilt = about({0, 1, 0}, slope) * about({1, 0, 0}, roll);
  const auto placed = [&](double x, double y, double z) {
    return Pose{tilt * Vector3(x, y, z), tilt};
  };
  World world(newton(), h);
  world.add(standing(placed(0, 0, -0.5), scene::Box{{20, 4, 0.5}}, 1));
  world.add(standing(placed(0, -1.05, 0), scene::Box{{20, 2, 1}}, 1));
  world.add(loose(placed(-5, 0, 0), cube, 1, mu));
  run(world, seconds, h);
  const double pressed = (std::cos(roll) + std::sin(roll)) * std::cos(slope);
  const double a = earth * (std::sin(slope) - mu * pressed);
  const double way = (tilt.conjugate() * origin(world, 2).position).x() + 5;
  EXPECT_NEAR(way, a / 2, 0.005 * a / 2 + 1.02 * a * h / 2);
}

TEST_P(NewtonAt, ABallBouncesToTheSquareOfItsRestitution) {
  World world(newton(true), h);
  scene::Entity ball = loose(at(0, 0, 1), scene::Sphere{0.05}, 0.2);
  ball.links[0].surface.restitution = 0.5;
  world.add(ball);
  run(world, std::sqrt(2 / earth) + 0.05, h);  // behind the first impact
  double highest = 0;
  for (int i = 0; i < 0.6 / h; ++i) {
    world.step();
    highest = std::max(highest, origin(world, 0).position.z());
  }
  EXPECT_NEAR(highest, 0.25, 0.0025 + 2 * h);
}

TEST_P(NewtonAt, ABallRollsDownASlopeAsItsInertiaSays) {
  const double angle = 0.2, seconds = 2;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  World world(newton(), h);
  world.add(standing({-0.5 * up, tilt}, scene::Box{{12, 2, 0.5}}, 1));
  const Vector3 centre(0, 0, 0.05);  // of the ball over its frame
  const Vector3 start = -4 * downhill + 0.05 * up - centre;
  world.add(loose(at(start.x(), start.y(), start.z()), scene::Sphere{0.05}, 0.1, 0.6));
  run(world, seconds, h);
  const Pose end = origin(world, 1);
  const double way = (end.position + end.orientation * centre - start - centre).dot(downhill);
  const double a = 5.0 / 7 * earth * std::sin(angle), expected = a * seconds * seconds / 2;
  EXPECT_NEAR(way, expected, 0.001 * expected + 1.02 * a * seconds * h / 2);
}

TEST_P(NewtonAt, ATileFloorIsAsSmoothAsOne) {
  // Down ten flush tiles without friction.
  const double angle = 0.15, seconds = 2;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  World world(newton(), h);
  const Vector3 start = -2.43 * downhill;
  world.add(loose({start, tilt}, cube, 0.1, 0));
  for (int i = 0; i < 12; ++i) {
    world.add(standing({(-2.75 + 0.5 * i) * downhill - 0.1 * up, tilt}, scene::Box{{0.5, 1, 0.1}}));
  }
  run(world, seconds, h);
  const double a = earth * std::sin(angle), expected = a * seconds * seconds / 2;
  const double way = (origin(world, 0).position - start).dot(downhill);
  EXPECT_NEAR(way, expected, 0.002 * expected + 1.02 * a * seconds * h / 2);
}

/// Bodies on a flat face: a rotated box, a cylinder, a pyramid. All are 10 cm wide and high.
std::vector<scene::Geometry> flat_shapes() {
  const std::vector<Vector3> corners{
      {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.1, 0}, {0.05, 0.05, 0.1}};
  return {cube, scene::Cylinder{0.05, 0.1}, std::get<scene::Hull>(scene::make_hull(corners))};
}

TEST_P(NewtonAt, TilesAreAsSmoothAsOneInEveryDirection) {
  // Down a slope of square tiles without friction, over their edges and corners.
  const double slope = 0.15, seconds = 0.9;
  const math::Quaternion tilt = about({0, 1, 0}, slope);
  const Vector3 downhill = tilt * Vector3::UnitX();
  const double a = earth * std::sin(slope), expected = a * seconds * seconds / 2;
  for (const scene::Geometry& shape : flat_shapes()) {
    for (const double yaw : {0.0, 0.3, std::numbers::pi / 4, 1.2}) {
      World world(newton(), h);
      const math::Quaternion turned = tilt * about({0, 0, 1}, yaw);
      const Pose start{turned * Vector3(0.01, 0.02, 0), turned * about({0, 0, 1}, 0.2)};
      world.add(loose(start, shape, 0.1, 0));
      for (int i = 0; i < 49; ++i) {
        const Vector3 place(0.25 * (i / 7 - 3), 0.25 * (i % 7 - 3), -0.05);
        world.add(standing({turned * place, turned}, scene::Box{{0.25, 0.25, 0.05}}, 1));
      }
      run(world, seconds, h);
      const Vector3 moved = origin(world, 0).position - start.position;
      EXPECT_NEAR(moved.dot(downhill), expected, 0.002 * expected + 1.02 * a * seconds * h / 2)
          << yaw;
      EXPECT_LT((moved - moved.dot(downhill) * downhill).norm(), 1e-5) << yaw;
      EXPECT_LT(origin(world, 0).orientation.angularDistance(start.orientation), 1e-3) << yaw;
    }
  }
}

/// Position of a fast plank after a while on a floor of tiles, or on a slab.
Pose slid_plank(bool on_tiles, double h) {
  World world(newton(), h);
  world.add(loose({{-2, -1.7, 0}, about({0, 0, 1}, 70 * std::numbers::pi / 180)},
                  scene::Box{{0.9, 0.1, 0.02}}, 1, 0.2));
  for (int i = 0; i < 121 && on_tiles; ++i) {
    world.add(
        standing(at(0.5 * (i / 11 - 7), 0.5 * (i % 11 - 6), -0.1), scene::Box{{0.5, 0.5, 0.1}}));
  }
  if (!on_tiles) world.add(standing(at(0, 0, -0.1), scene::Box{{20, 20, 0.1}}));
  const world::Push push{0, Vector3(3.2, 2.5, 0) / h, Vector3::Zero()};
  set_pushes(world, std::span(&push, 1));
  world.step();
  set_pushes(world, {});
  run(world, 0.9, h);
  return origin(world, 0);
}

// Its corner goes from a tile over the tip of a second one into a third within a substep: that
// one's side was hit.
TEST_P(NewtonAt, WhereFourTilesMeetIsNoEdge) {
  const Pose tiles = slid_plank(true, h), slab = slid_plank(false, h);
  EXPECT_LT((tiles.position - slab.position).norm(), 1e-6);
  EXPECT_LT(tiles.orientation.angularDistance(slab.orientation), 1e-6);
}

/// Tiles of 0.2 m whose corners meet at (0.2 i, y).
void lay_tiles(World& world, double y, double friction) {
  for (int i = -2; i < 2; ++i) {
    for (const double side : {-0.1, 0.1})
      world.add(standing(at(0.2 * i + 0.1, y + side, -0.1), scene::Box{{0.2, 0.2, 0.1}}, friction));
  }
}

/// By how much of its speed a cylinder of 0.05 x 0.1 m becomes slower on these tiles at most.
double lost_on_tiles(double y, bool lies, double speed, double seconds, double h) {
  World world(newton(), h);
  lay_tiles(world, y, 1);
  const scene::Cylinder shape{0.05, 0.1};
  const Pose lying{{-0.05, 0.05, 0.05}, about({1, 0, 0}, std::numbers::pi / 2)};
  world.add(loose(lies ? lying : at(-0.3, 0, 0), shape, 1, lies ? 1 : 0));
  const double spin = lies ? speed / shape.radius : 0, inertia = shape.radius * shape.radius / 2;
  const world::Push push{8, Vector3(speed, 0, 0) / h, Vector3(0, spin * inertia, 0) / h};
  set_pushes(world, std::span(&push, 1));
  world.step();
  set_pushes(world, {});
  double least = speed;
  for (int i = 1; i < seconds / h; ++i) {
    const double before = origin(world, 8).position.x();
    world.step();
    least = std::min(least, (origin(world, 8).position.x() - before) / h);
  }
  return 1 - least / speed;
}

// The contacts of two tiles were dropped, each because the other one goes on where it touches; and
// where a rim touched an edge exactly, its point was 1.5 mm beside it.
TEST_P(NewtonAt, WhatRollsOrSlidesOverFourTilesKeepsItsSpeed) {
  for (const double y : {-0.03, 0.02, 0.0, 0.05}) {
    EXPECT_LT(lost_on_tiles(y, true, 0.05, 2, h), 1e-3) << y;
    EXPECT_LT(lost_on_tiles(y, true, 1, 0.2, h), 1e-3) << y;
    EXPECT_LT(lost_on_tiles(y, false, 1, 0.5, h), 1e-5) << y;
  }
}

// Which tile goes on where another one ends was followed along all ways through the tiles: without
// end.
TEST(NewtonTiles, CarryAPlateThatCoversFourHundred) {
  World world(newton(), 0.01);
  for (int i = 0; i < 400; ++i)
    world.add(standing(at(0.05 * (i / 20) - 0.475, 0.05 * (i % 20) - 0.475, -0.05),
                       scene::Box{{0.05, 0.05, 0.05}}));
  world.add(loose({{0.003, 0.002, 0}, about({0, 0, 1}, 0.12)}, scene::Box{{1, 1, 0.02}}, 1));
  run(world, 0.1, 0.01);
  EXPECT_LT((origin(world, 400).position - Vector3(0.003, 0.002, 0)).norm(), 1e-6);
}

/// Four flush tiles of 0.5 x 1 x 0.1 m in one body, in a row along x.
scene::Entity platform(const Pose& pose, double friction) {
  std::vector<scene::Link> tiles;
  for (int i = 0; i < 4; ++i) {
    tiles.push_back(link("tile" + std::to_string(i), scene::Box{{0.5, 1, 0.1}}, 10));
  }
  scene::Entity entity = prototype("platform", pose, true, std::move(tiles));
  for (std::size_t i = 1; i < 4; ++i) {
    entity.joints.push_back(
        joint(scene::JointType::fixed, Vector3::UnitZ(), at(0.25, 0, 0), at(-0.25, 0, 0)));
    entity.joints.back().parent = i - 1;
    entity.joints.back().child = i;
  }
  return with_friction(std::move(entity), friction);
}

TEST_P(NewtonAt, TilesOfABodyThatIsFreeAreAsSmoothAsOne) {
  // A box without friction slides over a platform that stays on a slope, or slides slower.
  const double angle = 0.15, seconds = 1.4;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  for (const double friction : {1.0, 0.05}) {
    World world(newton(), h);
    world.add(standing({-1 * up, tilt}, scene::Box{{20, 4, 1}}, 1));
    world.add(platform({{0, 0, 0}, tilt}, friction));
    const Vector3 start = 0.1 * up;
    world.add(loose({start, tilt}, cube, 0.1, 0));
    run(world, seconds, h);
    const double a = earth * std::sin(angle), expected = a * seconds * seconds / 2;
    const Vector3 moved = origin(world, 2).position - start;
    EXPECT_NEAR(moved.dot(downhill), expected, 0.002 * expected + 1.02 * a * seconds * h / 2);
    EXPECT_NEAR(moved.dot(up), 0, 1e-4);
  }
}

TEST_P(NewtonAt, ASlowCylinderRollsOverSeams) {
  // 1 degree down: slow at the first seams.
  const double angle = 0.0175, seconds = 3;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  World world(newton(), h);
  const scene::Cylinder roll{0.02, 0.05};
  const math::Quaternion lying = tilt * about({1, 0, 0}, -EIGEN_PI / 2);  // z along y
  const Vector3 start = 0.02 * up - lying * Vector3(0, 0, 0.025);
  world.add(loose({start, lying}, roll, 0.1, 0.5));
  for (int i = 0; i < 12; ++i) {
    world.add(
        standing({(-0.049 + 0.05 * i) * downhill - 0.1 * up, tilt}, scene::Box{{0.05, 1, 0.1}}, 1));
  }
  run(world, seconds, h);
  const double a = earth * std::sin(angle) / 1.5, expected = a * seconds * seconds / 2;
  const Pose end = origin(world, 0);
  const Vector3 moved = end * Vector3(0, 0, 0.025) - Pose{start, lying} * Vector3(0, 0, 0.025);
  EXPECT_NEAR(moved.dot(downhill), expected, 0.01 * expected + 1.02 * a * seconds * h / 2);
}

TEST_P(NewtonAt, WhatFliesPastAnEdgeIsNotTouched) {
  const double height = 1.5;
  for (const bool round : {true, false}) {
    World world(newton(), h);
    world.add(standing(at(0.5 + 0.02 + 0.01, 0, -0.6), scene::Box{{1, 1, 0.6}}));
    const scene::Geometry body =
        round ? scene::Geometry(scene::Sphere{0.02}) : scene::Geometry(scene::Cylinder{0.02, 0.04});
    world.add(loose(at(0, 0, height), body, 0.1));
    run(world, 0.6, h);
    const Vector3 end = origin(world, 1).position;
    EXPECT_NEAR(end.z(), height - earth * 0.18, 1e-9);
    EXPECT_EQ(end.x(), 0);
  }
}

TEST_P(NewtonAt, WhatComesAtThreeHundredMetresPerSecondIsStopped) {
  World world(newton(), h);
  world.add(standing(at(0, 0, -0.01), scene::Box{{1, 1, 0.01}}));
  world.add(loose(at(0, 0, 4592), scene::Sphere{0.02}, 0.1));
  world.add(loose(at(0.3, 0, 4592), cube, 0.1));
  run(world, 32, h);
  EXPECT_NEAR(origin(world, 1).position.z(), 0, 1e-3);
  EXPECT_NEAR(origin(world, 2).position.z(), 0, 1e-3);
}

// A push was less than what counted as none beside the impulses on the light balls over their mass:
// the plate stood still for good.
TEST(NewtonPush, MovesAHeavyPlateOnLightBalls) {
  const double mass = 1e4, ball = 1e-3, push = 2000, seconds = 0.8;
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    World world(newton(true), 1 / hz);
    for (const double x : {-1, 1}) {
      for (const double y : {-1, 1}) world.add(loose(at(x, y, 0), scene::Sphere{0.02}, ball, 0.7));
    }
    world.add(loose(at(0, 0, 0.04), scene::Box{{2.5, 2.5, 0.5}}, mass, 0.7));
    run(world, 0.1, 1 / hz);
    const world::Push along{4, Vector3(push, 0, 0), Vector3::Zero()};
    set_pushes(world, std::span(&along, 1));
    run(world, seconds, 1 / hz);
    EXPECT_NEAR(state_of(world).links[4].velocity.x(), push * seconds / (mass + 4 * ball * 1.4 / 4),
                1e-4)
        << hz;
  }
}

}  // namespace
}  // namespace ziggurat::physics
