// SPDX-License-Identifier: MIT
// Bodies at rest stay: towers, mass ratios, planks, card houses.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "../long_runs.h"
#include "math/random.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Drift of the top in a minute at 100 Hz [m].
double tower_drift(int count, const scene::Geometry& geometry, double height, double mass) {
  World world(newton(true), 0.01);
  for (int i = 0; i < count; ++i) world.add(loose(at(0, 0, i * height), geometry, mass));
  run(world, long_runs::a_minute, 0.01);
  EXPECT_EQ(world.convergence().not_converged, 0u);
  return (origin(world, count - 1).position - Vector3(0, 0, (count - 1) * height)).norm();
}

TEST(NewtonTower, OfTenCentimetreBoxesStands) {
  EXPECT_LT(tower_drift(10, scene::Box{{0.01, 0.01, 0.01}}, 0.01, 0.001), 1e-4);
}
TEST(NewtonTower, OfTwentyCentimetreBoxesStands) {
  EXPECT_LT(tower_drift(20, scene::Box{{0.01, 0.01, 0.01}}, 0.01, 0.001), 1e-4);
}
TEST(NewtonTower, OfTwentyLargeBoxesStands) {
  EXPECT_LT(tower_drift(20, scene::Box{{0.05, 0.05, 0.05}}, 0.05, 0.1), 1e-4);
}
TEST(NewtonTower, OfTwentyCylindersStands) {
  EXPECT_LT(tower_drift(20, scene::Cylinder{0.005, 0.01}, 0.01, 0.001), 1e-4);
}

// Two squares that are turned against each other share an octagon: which four of its corners carry
// must not change by rounding.
TEST(NewtonTower, OfTurnedBoxesComesToRest) {
  math::RandomStream random(6, "turned");
  for (const double hz : {100.0, 200.0, 500.0, 200.0, 500.0}) {
    World world(newton(true), 1 / hz);
    for (int i = 0; i < 20; ++i) {
      const Vector3 place(random.uniform(-0.003, 0.003), random.uniform(-0.003, 0.003), i * 0.05);
      const double angle = random.uniform(0, std::numbers::pi / 2);
      const math::Quaternion turned(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
      world.add(loose({place, turned}, scene::Box{{0.05, 0.05, 0.05}}, 0.1));
    }
    run(world, 1, 1 / hz);
    for (const world::LinkState& link : state_of(world).links) {
      EXPECT_EQ(link.velocity, Vector3(0, 0, 0)) << hz;
      EXPECT_EQ(link.angular_velocity, Vector3(0, 0, 0)) << hz;
    }
  }
}

TEST(NewtonStack, HeavyStandsOnLight) {
  for (const double ratio : {100.0, 1000.0}) {
    World world(newton(true), 0.01);
    world.add(loose(at(0, 0, 0), scene::Box{{0.1, 0.1, 0.1}}, 1));
    world.add(loose(at(0, 0, 0.1), scene::Box{{0.1, 0.1, 0.1}}, ratio));
    run(world, 10, 0.01);
    EXPECT_LT((origin(world, 1).position - Vector3(0, 0, 0.1)).norm(), 1e-4) << ratio;
  }
}

/// Tilted about x, from where it stands upright [rad].
Pose tilted(double x, double y, double z, double angle) {
  return {Vector3(x, y, z), math::Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitX()))};
}

scene::Entity rail(double x) {
  return with_friction(prototype("rail", tilted(x, 0.15, 0.05, std::numbers::pi / 2), false,
                                 {link("a", scene::Cylinder{0.05, 0.3}, 1)}),
                       1);
}

// The two ends of what a log shares with a rail have their own distances: with the same it stayed
// tilted in the air.
TEST(NewtonLog, FallsIntoItsGrooveThoughItBeginsTilted) {
  for (const double hz : long_runs::some_of({50.0, 200.0, 1000.0})) {
    for (const scene::Geometry& log : {scene::Geometry(scene::Cylinder{0.05, 0.2}),
                                       scene::Geometry(scene::Capsule{0.05, 0.2})}) {
      World world(newton(), 1 / hz);
      world.add(rail(-0.06));
      world.add(rail(0.06));
      world.add(loose(tilted(0, 0.1, 0.16, std::numbers::pi / 2 + 0.1), log, 1, 1));
      run(world, 2, 1 / hz);
      const Pose end = origin(world, 2);
      EXPECT_NEAR((end.orientation * Vector3::UnitZ()).z(), 0, 1e-4) << hz;
      EXPECT_NEAR(end.position.z(), 0.13, 1e-4) << hz;  // 0.05 + sqrt(0.1^2 - 0.06^2)
    }
  }
}

TEST(NewtonPlank, FallsOntoItsRollersThoughItBeginsTilted) {
  for (const double hz : long_runs::some_of({50.0, 200.0, 1000.0})) {
    for (const double angle : {0.02, 0.1, 0.3}) {
      World world(newton(), 1 / hz);
      world.add(rail(-0.3));
      world.add(rail(0.3));
      world.add(loose(tilted(0, 0, 0.11 + 0.1 * angle, angle), scene::Box{{2, 0.2, 0.02}}, 1, 1));
      run(world, 2, 1 / hz);
      const Pose end = origin(world, 2);
      EXPECT_NEAR((end.orientation * Vector3::UnitY()).z(), 0, 1e-4) << hz << " from " << angle;
      EXPECT_NEAR(end.position.z(), 0.1, 1e-4) << hz << " from " << angle;
    }
  }
}

/// An ellipsoid of 60 corners.
scene::Geometry pebble() {
  std::vector<Vector3> corners;
  for (int i = 0; i < 60; ++i) {
    const double z = 1 - (2 * i + 1) / 60.0, angle = i * std::numbers::pi * (3 - std::sqrt(5.0)),
                 around = std::sqrt(1 - z * z);
    corners.push_back({0.1 * around * std::cos(angle), 0.05 * around * std::sin(angle), 0.03 * z});
  }
  return std::get<scene::Hull>(scene::make_hull(corners));
}

// Higher corners within reach of the floor displaced the supporting ones: it vibrated, and never
// slept.
TEST(NewtonHull, OfManyCornersComesToRestOnTheFloor) {
  for (const double hz : long_runs::some_of({50.0, 100.0, 500.0})) {
    for (const double angle : {0.1, 0.8}) {
      World world(newton(true), 1 / hz);
      world.add(loose(tilted(0, 0, 0.08, angle), pebble(), 1, 1));
      run(world, 10, 1 / hz);
      const Pose rest = origin(world, 0);
      run(world, 1, 1 / hz);
      EXPECT_EQ(origin(world, 0).position, rest.position) << hz << " from " << angle;
    }
  }
}

// The contacts of sleepers are told again in the very substep in which they wake.
TEST(NewtonStack, IsCarriedWhenItIsWoken) {
  const double h = 0.01;
  World world(newton(true), h);
  for (int i = 0; i < 3; ++i) world.add(loose(at(0, 0, 0.1 * i), cube, 1));
  run(world, 1, h);
  world.add(loose(at(0, 0, 0.5), scene::Sphere{0.02}, 0.1));  // falls 0.2 m: 0.2 s
  world.watch_contacts(0, 0);
  int pressed = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    const LinkTouch touch = world.take_touch(0, 0);
    // From below the weight of three, from above that of two; at the impact more.
    EXPECT_GT(touch.magnitude, 4.99 * earth * h) << i;
    pressed += touch.magnitude > 5.2 * earth * h;
    EXPECT_GT(origin(world, 0).position.z(), -1e-6) << i;
  }
  EXPECT_GE(pressed, 1);  // the ball did arrive, and woke them
  EXPECT_NEAR(origin(world, 3).position.z(), 0.3, 1e-4);
}

TEST(NewtonStack, ThatSleepsMovesWithNothingAndWakesWhenItsFloorIsTaken) {
  World world(newton(), 0.01);
  world.add(standing(at(0, 0, -0.5), scene::Box{{1, 1, 0.5}}));
  world.add(loose(at(0, 0, 0), cube, 1));
  world.add(loose(at(0, 0, 0.1), cube, 1));
  run(world, 1, 0.01);
  const Pose rest = origin(world, 2);
  run(world, 1, 0.01);
  EXPECT_EQ(origin(world, 2).position, rest.position);
  world.remove(0);
  run(world, 0.5, 0.01);
  EXPECT_NEAR(origin(world, 2).position.z(), rest.position.z() - earth * 0.125, 1e-6);
}

// A plate on 25 cubes, whose middle is not below its own: a rigid plate on springs, so loads are
// linear in the place.
TEST(NewtonPlate, LoadsTwentyFiveCubesLinearly) {
  constexpr double pitch = 0.05, mass = 10, cube_mass = 0.1;
  const double away_x = 0.02, away_y = 0.01;  // of the cubes' middle
  for (const double hz : long_runs::some_of({50, 100, 500, 2000})) {
    World world(newton(true), 1 / hz);
    world.add(loose(at(0, 0, 0.02), scene::Box{{0.4, 0.4, 0.02}}, mass, 0.5));
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i < 25; ++i) places.emplace_back(pitch * (i % 5 - 2), pitch * (i / 5 - 2));
    for (const auto& place : places) {
      world.add(loose(at(place.x() + away_x, place.y() + away_y, 0), scene::Box{{0.02, 0.02, 0.02}},
                      cube_mass, 0.5));
    }
    run(world, 1, 1 / hz);
    std::vector<world::Contact> contacts;
    world.list_contacts(contacts);
    std::vector<double> loads(places.size(), 0);
    for (const world::Contact& contact : contacts) {
      if (!contact.other) loads[contact.link - 1] += contact.force.z();
    }
    const double square = 50 * pitch * pitch +
                          25 * 0.01 * 0.01;  // sum of x^2 over the cubes' corners, a quarter [m^2]
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double share = 1.0 / 25 - (away_x * places[i].x() + away_y * places[i].y()) / square;
      EXPECT_NEAR(loads[i], earth * (mass * share + cube_mass), 1e-3 * earth * mass / 25)
          << hz << ' ' << i;
    }
  }
}

TEST(NewtonCards, AHouseOfThreeStoreysStands) {
  const double length = 0.08, thick = 0.001, width = 0.06, lean = 0.3;
  const scene::Box card{{width, thick, length}};
  World world(newton(true), 0.01);
  const double foot = length * std::sin(lean), high = length * std::cos(lean);
  const double storey = high + thick * std::sin(lean) + thick;
  int cards = 0;
  const auto lean_to = [&](double y, double z, double angle) {
    // A card's bottom edge at (y, z); its frame is at the middle of its lower face.
    const math::Quaternion turn = about({1, 0, 0}, angle);
    const double lift = thick / 2 * std::abs(std::sin(angle));
    world.add(loose({{0, y, z + lift}, turn}, card, 0.002, 0.9));
    ++cards;
  };
  for (int level = 0; level < 3; ++level) {
    const int tents = 3 - level;
    const double z = level * storey;
    for (int t = 0; t < tents; ++t) {
      const double y = (t - (tents - 1) / 2.0) * (2 * foot + 0.004);
      const double half = foot + thick / 2 / std::cos(lean);
      lean_to(y - half, z, -lean);
      lean_to(y + half, z, lean);
    }
    if (level == 2) break;
    world.add(loose(at(0, 0, z + storey - thick),
                    scene::Box{{width, (tents - 1) * (2 * foot + 0.004) + foot, thick}},
                    0.002 * tents, 0.9));
    ++cards;
  }
  std::vector<Vector3> start;
  for (int i = 0; i < cards; ++i) start.push_back(origin(world, i).position);
  run(world, long_runs::a_minute, 0.01);
  for (int i = 0; i < cards; ++i) {
    EXPECT_LT((origin(world, i).position - start[i]).norm(), 2e-3) << "card " << i;
  }
}

// All of the weight is on a rim of 5 cm, and a little beside its middle.
TEST(NewtonStack, ALoadOfTonsStandsOnALightCylinder) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(true), 1 / hz);
    world.add(loose(at(0, 0, 0), scene::Cylinder{0.05, 0.1}, 0.1));
    world.add(loose(at(0.004, 0.003, 0.1), scene::Box{{0.1, 0.1, 0.1}}, 1000));
    run(world, 10, 1 / hz);
    EXPECT_LT((origin(world, 0).position - Vector3(0, 0, 0)).norm(), 1e-6) << hz;
    EXPECT_LT((origin(world, 1).position - Vector3(0.004, 0.003, 0.1)).norm(), 1e-6) << hz;
  }
}

// It tips where the push at its middle has a larger moment about the rim than its weight, whichever
// part of the rim that is.
TEST(NewtonCylinder, TipsOverEachPointOfItsRimAlike) {
  const double radius = 0.05, height = 0.2, mass = 1;
  const double threshold = mass * earth * radius / (height / 2);
  for (const double heading : {0.0, 0.3, M_PI / 4, 1.2}) {
    for (const double hz : long_runs::substep_rates()) {
      for (const double share : {0.98, 1.02}) {
        scene::Physics physics = newton(true);
        physics.floor->surface.friction = 1;
        World world(physics, 1 / hz);
        world.add(loose({{0, 0, 0}, about(Vector3::UnitZ(), heading)},
                        scene::Cylinder{radius, height}, mass, 1));
        for (int i = 1; i <= 10; ++i) {  // it grows within a second
          const world::Push push{0, {share * threshold * i / 10, 0, 0}, {0, 0, 0}};
          set_pushes(world, std::span(&push, 1));
          run(world, i < 10 ? 0.1 : 2, 1 / hz);
        }
        const Vector3 up = origin(world, 0).orientation * Vector3::UnitZ();
        const double tilt = std::acos(std::min(1.0, up.z()));
        if (share > 1) {
          EXPECT_GT(tilt, 0.1) << heading << ' ' << hz;
        } else {
          EXPECT_LT(tilt, 1e-5) << heading << ' ' << hz;
          EXPECT_LT(origin(world, 0).position.norm(), 1e-6) << heading << ' ' << hz;
        }
      }
    }
  }
}

/// Drift in 2 s of one of two cards that lean on each other, held by friction alone [m].
double slip_of_cards(double lean, double friction, double hz) {
  const double length = 0.08, thick = 0.001, width = 0.06;
  scene::Physics physics = newton(true);
  physics.floor->surface.friction = 1;
  World world(physics, 1 / hz);
  const double y = length * std::sin(lean) + thick / 2 * std::cos(lean);
  for (const double side : {-1, 1}) {
    const Pose pose{{0, side * y, thick / 2 * std::sin(lean)}, about({1, 0, 0}, side * lean)};
    scene::Entity card = loose(pose, scene::Box{{width, thick, length}}, 0.002, friction);
    world.add(card);
  }
  const Vector3 start = origin(world, 0).position;
  run(world, 2, 1 / hz);
  return (origin(world, 0).position - start).norm();
}

// Each card presses the other by H horizontally and the floor by its weight w. About its lower
// edge: H length cos(lean) = w (length sin(lean) - thick cos(lean)) / 2.
TEST(NewtonCards, LeanOnEachOtherWithTheFrictionThatTheyNeed) {
  for (const double lean : {0.2, 0.4, 0.6}) {
    const double needed = std::tan(lean) / 2 - 0.001 / 0.16;
    for (const double hz : long_runs::substep_rates()) {
      EXPECT_LT(slip_of_cards(lean, 1.01 * needed, hz), 1e-6) << lean << ' ' << hz;
      EXPECT_GT(slip_of_cards(lean, 0.99 * needed, hz), 1e-3) << lean << ' ' << hz;
    }
  }
}

// On the seam of two flush tiles of different friction one contact is dropped; which one does not
// depend on pairs that others have left behind.
TEST(NewtonSeam, DoesNotDependOnWhatIsFarAway) {
  const auto slide = [](bool other) {
    World world(newton(true), 0.01);
    const scene::Box tile{{0.2, 0.4, 0.1}};
    world.add(standing(at(-0.1, 0, 0), tile, 0.1));
    world.add(standing(at(0.1, 0, 0), tile, 1));
    world.add(loose(at(0, 0, 0.13), scene::Sphere{0.02}, 1, 1));
    if (other) {
      world.add(standing(at(49.9, 0, 0), tile, 1));
      world.add(standing(at(50.1, 0, 0), tile, 1));
      world.add(loose(at(50, 0, 0.1001), scene::Sphere{0.02}, 1, 1));
    }
    const world::Push push{2, {0, 50, 0}, {0, 0, 0}};  // to 0.5 m/s
    set_pushes(world, std::span(&push, 1));
    world.step();
    set_pushes(world, {});
    if (other) world.move(5, at(50, 0, 3));
    run(world, 0.2, 0.01);
    return origin(world, 2).position;
  };
  EXPECT_EQ(slide(false), slide(true));
}

TEST(NewtonPile, DoesNotDependOnWhatIsFarAway) {
  const auto pile = [](bool other) {
    World world(newton(true), 0.01);
    for (int i = 0; i < 30; ++i) {
      world.add(loose({{0.012 * (i % 3), 0.011 * (i / 3 % 3), 0.03 + 0.03 * (i / 9)},
                       about({1, 2, 3}, 0.3 * i)},
                      scene::Box{{0.02, 0.02, 0.02}}, 0.01));
    }
    if (other) world.add(loose(at(50, 0, 0.1), scene::Box{{0.1, 0.1, 0.1}}, 1));
    run(world, long_runs::is_slow ? 0.3 : 1.5, 0.01);
    std::vector<Vector3> positions;
    for (int i = 0; i < 30; ++i) positions.push_back(origin(world, i).position);
    return positions;
  };
  EXPECT_EQ(pile(false), pile(true));
}

// A plate on a slide that touches the walls on both sides cannot come nearer to them: it stood
// still, held by the friction of 4e13 N.
TEST(NewtonPress, FitsItsBoxExactlyAndMoves) {
  const double size = 0.02, width = 3 * size, gap = 0.01;
  World world(newton(true), 0.01);
  for (const double side : {-1.0, 1.0}) {
    world.add(standing(at(side * (width / 2 + 0.01), 0, 0), scene::Box{{0.02, 0.2, 0.1}}));
    world.add(standing(at(0, side * (width / 2 + 0.01), 0), scene::Box{{width, 0.02, 0.1}}));
  }
  for (int i = 0; i < 18; ++i) {
    world.add(loose(at((i % 3 - 1) * size, (i / 3 % 3 - 1) * size, i / 9 * size),
                    scene::Box{{size, size, size}}, 0.01));
  }
  scene::Entity press = prototype("press", at(0, 0.5, 0), false,
                                  {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                   link("plate", scene::Box{{width, width, 0.02}}, 0.1)});
  press.joints.push_back(
      joint(scene::JointType::prismatic, Vector3::UnitZ(), at(0, -0.5, 2 * size + gap), {}));
  world.add(with_friction(press, 0.5));
  const JointIndex index = world.joint(22, 0);
  world.add_motor(index, scene::JointMode::velocity, 20 * 0.01);
  world.set_target(index, -1000);
  run(world, 0.5, 0.01);
  EXPECT_NEAR(world.position(index), -gap, 1e-4);
}

// However heavy it is: a wall that is nearly along its way stops it.
TEST(NewtonPress, StopsAtAWallThatIsNearlyAlongItsWay) {
  const double gap = 0.1;
  for (const double mass : {1.0, 1e6, 1e8}) {
    for (const double tilt : {0.001, 0.01, 0.1}) {
      World world(newton(), 0.01);
      scene::Entity slide = prototype("slide", at(0, 0, 0), false,
                                      {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                       link("ball", scene::Sphere{0.1}, mass)});
      slide.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitZ(), at(1, 0, 0), {}));
      world.add(with_friction(slide, 0));
      // The wall's face leans by the tilt; the ball's lower side comes to it after the gap.
      const math::Quaternion leaning(Eigen::AngleAxisd(-tilt, Vector3::UnitY()));
      const Vector3 normal = leaning * Vector3::UnitX(),
                    touch = Vector3(1, 0, 0.1 - gap) - 0.1 * normal;
      world.add(standing({touch - 0.5 * normal - leaning * Vector3(0, 0, 2), leaning},
                         scene::Box{{1, 1, 4}}, 0));
      run(world, 0.4, 0.01);
      EXPECT_NEAR(world.position(world.joint(0, 0)), -gap, 0.01 * gap) << mass << ' ' << tilt;
    }
  }
}

// Overlaps across the paths of both bodies are not resolved, and hold neither.
TEST(NewtonPress, TwoSlidesThatOverlapAcrossTheirWaysMove) {
  World world(newton(), 0.01);
  for (const double side : {-1.0, 1.0}) {
    scene::Entity slide = prototype("slide", at(0, side * 1.0, 0), false,
                                    {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                     link("head", scene::Box{{0.1, 0.1, 0.1}}, 1)});
    slide.joints.push_back(
        joint(scene::JointType::prismatic, Vector3::UnitZ(), at(0, -side * 0.951, 0), {}));
    world.add(with_friction(slide, 1));
  }
  world.add_motor(world.joint(1, 0), scene::JointMode::velocity, 1);
  run(world, 0.5, 0.01);
  EXPECT_NEAR(world.position(world.joint(0, 0)), -earth * 0.25 / 2, 0.02);
  EXPECT_NEAR(world.position(world.joint(1, 0)), 0, 1e-6);
}

}  // namespace
}  // namespace ziggurat::physics
