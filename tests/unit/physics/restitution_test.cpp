// SPDX-License-Identifier: MIT
// Bodies that rebound and turn. What rebounds straight is in
// sliding_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

math::Quaternion random_turn(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return math::Quaternion(w, x, y, z).normalized();
}

/// Largest rotation of links in a substep, over that of their velocities before and after it.
class Turned {
 public:
  explicit Turned(const World& world) : before_(state_of(world)) {}

  void look(const World& world, double h) {
    const world::State now = state_of(world);
    for (std::size_t i = 0; i < now.links.size(); ++i) {
      const world::LinkState &one = before_.links[i], &other = now.links[i];
      const double speed = std::max(one.angular_velocity.norm(), other.angular_velocity.norm());
      const double angle = one.pose.orientation.angularDistance(other.pose.orientation);
      most = std::max(most, angle);
      if (h * speed < 1) worst = std::max(worst, angle / (h * speed + 1e-3));
    }
    before_ = now;
  }
  double worst = 0;  ///< rotation in a substep over that of the greater speed
  double most = 0;   ///< rotation in a substep [rad]

 private:
  world::State before_;
};

/// Motion of a cube: of its centre, in W.
struct Flight {
  Vector3 place, velocity, turning;
  math::Quaternion orientation;
};

Flight flight_of(const world::LinkState& link, double side) {
  const Vector3 up = link.pose.orientation * Vector3(0, 0, side / 2);
  return {link.pose.position + up, link.velocity + link.angular_velocity.cross(up),
          link.angular_velocity, link.pose.orientation};
}

/// Its lowest corner after a time, from its centre.
Vector3 lowest_corner(const Flight& cube, double side, double time) {
  const double angle = cube.turning.norm() * time;
  const math::Quaternion turned =
      math::Quaternion(Eigen::AngleAxisd(angle, cube.turning.normalized())) * cube.orientation;
  Vector3 lowest = Vector3::Zero();
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner =
        turned * (side / 2 * Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    if (corner.z() < lowest.z()) lowest = corner;
  }
  return lowest;
}

/// Moves a cube freely until a corner hits the floor, and rebounds it by Newton's law: on a smooth
/// floor, or on one where the corner sticks.
void rebound(Flight& cube, double side, double mass, double restitution, bool sticks) {
  double early = 0, late = 1;
  while (late - early > 1e-12) {
    const double middle = (early + late) / 2;
    (cube.place.z() + middle * cube.velocity.z() + lowest_corner(cube, side, middle).z() > 0
         ? early
         : late) = middle;
  }
  const Vector3 lever = lowest_corner(cube, side, early),
                speed = cube.velocity + cube.turning.cross(lever);
  const double inertia = mass * side * side / 6;
  const Eigen::Matrix3d response =
      Eigen::Matrix3d::Identity() / mass +
      (lever.squaredNorm() * Eigen::Matrix3d::Identity() - lever * lever.transpose()) / inertia;
  Vector3 impulse = -(1 + restitution) * speed.z() / response(2, 2) * Vector3::UnitZ();
  if (sticks)
    impulse = response.inverse() * Vector3(-speed.x(), -speed.y(), -(1 + restitution) * speed.z());
  cube.velocity += impulse / mass;
  cube.turning += lever.cross(impulse) / inertia;
}

// Levers were those of the substep's beginning: impulses were off by 17 % at 50 Hz, and by 3 % at
// 200 Hz, in the mean.
TEST(NewtonRebound, OfACornerThatTurnsHasTheLeverOfTheTouch) {
  constexpr double side = 0.2, mass = 1, restitution = 0.8;
  std::vector<std::pair<double, bool>> all;
  for (const double hz : long_runs::substep_rates()) {
    for (const bool sticks : {false, true}) all.emplace_back(hz, sticks);
  }
  for (const auto& [hz, sticks] : all) {
    std::mt19937 random(7);
    std::vector<double> errors;
    for (int i = 0; i < 21; ++i) {
      World world(newton(true, 0), 1 / hz);
      scene::Entity box = loose({{0, 0, 0.5 + 0.01 * i}, random_turn(random)},
                                scene::Box{{side, side, side}}, mass, sticks ? 100 : 0);
      box.links[0].surface.restitution = restitution;
      world.add(box);
      std::normal_distribution<double> normal;
      const double x = normal(random), y = normal(random), z = normal(random);
      const Vector3 turning = 16 * Vector3(x, y, z).normalized(), velocity(0.5, 0, -3);
      set_pushes(world, std::array{world::Push{0, hz * mass * velocity,
                                               hz * mass * side * side / 6 * turning}});
      world.step();
      set_pushes(world, {});
      Flight cube = flight_of(state_of(world).links[0], side);
      rebound(cube, side, mass, restitution, sticks);
      for (int n = 0; n < hz && (state_of(world).links[0].angular_velocity - turning).norm() < 1e-6;
           ++n)
        world.step();
      const Flight now = flight_of(state_of(world).links[0], side);
      errors.push_back(std::hypot((now.velocity - cube.velocity).norm(),
                                  side / std::sqrt(6) * (now.turning - cube.turning).norm()) /
                       3);
    }
    std::ranges::sort(errors);
    EXPECT_LT(errors[10], 1e-4) << hz << ' ' << sticks;
    if (hz >= 200) {  // at lower rates another corner may strike in the same substep
      EXPECT_LT(errors.back(), 1e-3) << hz << ' ' << sticks;
    }
  }
}

// Two corners with impacts at different times in a substep asked for rotations of up to 34 times
// the bound. No rotation is faster than all its energy about the axis of the least inertia. With
// one impact in a substep it moves by v h, and to its target gaps by up to |v1 - v0| h, at most
// twice the greater of the speeds.
TEST(NewtonRebound, TurnsABoxAsItsSpeedsSay) {
  const Vector3 size(0.033, 0.131, 0.086);
  const double height = 0.3,
               least_inertia = (size.x() * size.x() + size.z() * size.z()) / 12;  // of 1 kg
  const double fastest = std::sqrt(2 * earth * height / least_inertia);
  std::mt19937 random(3);
  for (const double hz : long_runs::substep_rates()) {
    for (int i = 0; i < 10; ++i) {
      World world(newton(true), 1 / hz);
      scene::Entity box = loose({{0, 0, height}, random_turn(random)}, scene::Box{size}, 1);
      box.links[0].surface.restitution = 1;
      world.add(box);
      Turned turned(world);
      for (int n = 0; n < hz; ++n) {
        world.step();
        turned.look(world, 1 / hz);
      }
      EXPECT_LT(turned.most, fastest / hz) << hz << ' ' << i;
      // At lower rates several corners may strike in a substep.
      if (hz >= 200) {
        EXPECT_LT(turned.worst, 3.03) << hz << ' ' << i;
      }
    }
  }
}

/// Heights of a ball, the last entity of two, after each of its rebounds, from its energy [m].
/// @param top  of what it falls on [m]
std::vector<double> rises(World& world, double top, double hz) {
  std::vector<double> out;
  double before = 0;
  for (int i = 0; i < hz; ++i) {
    world.step();
    const double speed = state_of(world).links.back().velocity.z();
    if (before < -0.1 && speed > 0)
      out.push_back(origin(world, 1).position.z() - top + speed * speed / (2 * earth));
    before = speed;
  }
  return out;
}

scene::Entity ball_above(double top) {
  scene::Entity ball = loose(at(0.03, 0.02, top + 0.3), scene::Sphere{0.03}, 0.1, 0);
  ball.links[0].surface.restitution = 0.7;
  return ball;
}

// Impacts that only gravity within the substep brings about were missed: 4 % of the energy was lost
// at 50 Hz.
TEST(NewtonRebound, IsSeenAtEachMomentOfASubstep) {
  for (const double gravity : {earth, 24.8}) {
    for (const double hz : long_runs::substep_rates({.most = 1000})) {
      World world(newton(true, gravity), 1 / hz);
      const auto height = [](std::size_t i) { return 0.05 + 0.0065 * static_cast<double>(i); };
      constexpr std::size_t count = 200;
      for (std::size_t i = 0; i < count; ++i) {
        scene::Entity ball =
            loose(at(3.0 * static_cast<double>(i), 0, height(i)), scene::Sphere{0.1}, 1, 0);
        ball.id += std::to_string(i);
        ball.links[0].surface.restitution = 1;
        world.add(ball);
      }
      double worst = 0;
      for (int step = 0; step < hz; ++step) {
        world.step();
        const world::State now = state_of(world);
        for (std::size_t i = 0; i < count; ++i) {
          const world::LinkState& ball = now.links[i];
          const double energy = ball.velocity.squaredNorm() / 2 + gravity * ball.pose.position.z();
          worst = std::max(worst, std::abs(energy / (gravity * height(i)) - 1));
        }
      }
      EXPECT_LT(worst, 1e-6) << gravity << ' ' << hz;
    }
  }
}

// The ball left from its position at the substep's beginning, because the supported body below it
// could not move as the masses say. It rose to 0.189, 0.123 and 0.090 m at 50 Hz instead of 0.147,
// 0.072 and 0.035, without end.
TEST(NewtonRebound, OnWhatTheFloorCarriesIsAsOnTheFloor) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double thickness : {0.1, 0.02}) {  // a step leads through a thin one, to the floor
      World world(newton(true), 1 / hz);
      world.add(loose(at(0, 0, 0), scene::Box{{0.3, 0.3, thickness}}, 1, 0.5));
      world.add(ball_above(thickness));
      const std::vector<double> found = rises(world, thickness, hz);
      ASSERT_GE(found.size(), 2u) << hz << ' ' << thickness;
      EXPECT_NEAR(found[0], 0.3 * 0.49, 1e-5) << hz << ' ' << thickness;
      EXPECT_NEAR(found[1], 0.3 * 0.49 * 0.49, 1e-5) << hz << ' ' << thickness;
    }
  }
}

TEST(NewtonRebound, OnWhatAMotorHoldsIsAsOnTheFloor) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(false), 1 / hz);
    scene::Entity lift = prototype("lift", at(0, 0, 0), false,
                                   {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                    link("platform", scene::Box{{0.3, 0.3, 0.1}}, 1)});
    lift.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitZ(), at(0, 0, 0.2), {}));
    world.add(lift);
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1000 / hz);
    world.add(ball_above(0.3));
    const std::vector<double> found = rises(world, 0.3, hz);
    ASSERT_GE(found.size(), 2u) << hz;
    EXPECT_NEAR(found[0], 0.3 * 0.49, 1e-5) << hz;
    EXPECT_NEAR(found[1], 0.3 * 0.49 * 0.49, 1e-5) << hz;
  }
}

// Points that meet within a micrometre have their impact together. One side was first, and it left
// with 7 rad/s, because the block had pressed its end of the plate down by less than that.
TEST(NewtonRebound, FlatOnWhatCarriesAnotherDoesNotTurn) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double phase : {0.1, 0.4, 0.7, 0.9}) {
      for (const bool cylinder : {false, true}) {
        World world(newton(true), 1 / hz);
        world.add(loose(at(0, 0, 0), scene::Box{{0.5, 0.2, 0.02}}, 0.3));
        world.add(loose(at(-0.15, 0, 0.02), scene::Box{{0.04, 0.04, 0.04}}, 0.05));
        const double time = (std::floor(0.25 * hz) + phase) / hz;
        const scene::Geometry shape =
            cylinder ? scene::Geometry(scene::Cylinder{0.05, 0.1}) : scene::Box{{0.1, 0.1, 0.1}};
        scene::Entity falling = loose(at(0, 0, 0.02 + earth * time * time / 2), shape, 1, 0);
        falling.links[0].surface.restitution = 0.8;
        world.add(falling);
        for (int i = 0; i < std::floor(0.25 * hz) + 1; ++i) world.step();
        const world::LinkState link = state_of(world).links.back();
        EXPECT_NEAR(link.velocity.z(), 0.8 * earth * time - (1 - phase) * earth / hz, 1e-3)
            << hz << ' ' << phase << ' ' << cylinder;
        EXPECT_LT(link.angular_velocity.norm(), 1e-3) << hz << ' ' << phase << ' ' << cylinder;
      }
    }
  }
}

// It struck in every substep, and the bound of its energy took its speed along the wall: 0.03 m at
// 100 Hz.
TEST(NewtonRebound, WhatIsPressedSlides) {
  for (const double hz : long_runs::substep_rates({.first = 100})) {
    for (const double press : {1.0, 3.0, 10.0}) {
      World world(newton(false, 0), 1 / hz);
      world.add(standing(at(0.52, 0, -5), scene::Box{{1, 10, 10}}, 1));
      scene::Entity box = loose(at(0, 0, 0), scene::Box{{0.04, 0.04, 0.04}}, 0.1, 0.05);
      box.links[0].surface.restitution = 0.5;
      world.add(box);
      const world::Push push{1, Vector3(press, 1, 0), Vector3::Zero()};
      set_pushes(world, std::span(&push, 1));
      const double along = (1 - 0.05 * press) / 0.1, steps = hz / 2;  // each begins with its push
      for (int i = 0; i < steps; ++i) world.step();
      EXPECT_NEAR(origin(world, 1).position.y(), along * steps * (steps + 1) / 2 / hz / hz, 1e-4)
          << hz << ' ' << press;
      EXPECT_LT(std::abs(origin(world, 1).position.x()), 1e-5) << hz << ' ' << press;
    }
  }
}

// The floor's share of a push is no energy that the body lacks: slow ones stopped at the wall.
TEST(NewtonRebound, WhatIsPressedReboundsFromAWall) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double speed : {0.1, 0.5, 2.0}) {
      World world(newton(true), 1 / hz);
      world.add(standing(at(0.52 + speed / 10, 0, 0), scene::Box{{1, 10, 1}}, 0));
      scene::Entity box = loose(at(0, 0, 0), scene::Box{{0.04, 0.04, 0.04}}, 0.1, 0);
      box.links[0].surface.restitution = 1;
      world.add(box);
      world::Push push{1, Vector3(0.1 * speed * hz, 0, -5), Vector3::Zero()};
      for (int i = 0; i < hz / 5; ++i) {
        set_pushes(world, std::span(&push, 1));
        world.step();
        push.force.x() = 0;
      }
      EXPECT_NEAR(state_of(world).links.back().velocity.x(), -speed, 1e-4) << hz << ' ' << speed;
    }
  }
}

// Both speeds were 0.
TEST(NewtonRebound, AfterAPushOfOneSubstep) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double gap : {0.02, 0.2, 0.6}) {  // of its way
      World world(newton(false, 0), 1 / hz);
      world.add(standing(at(0.52 + gap * 5 / hz, 0, -5), scene::Box{{1, 10, 10}}));
      scene::Entity ball = loose(at(0, 0, 0), scene::Sphere{0.02}, 0.1, 0);
      ball.links[0].surface.restitution = 0.5;
      world.add(ball);
      const world::Push push{1, Vector3(0.5 * hz, 0.3 * hz, 0), Vector3::Zero()};
      set_pushes(world, std::span(&push, 1));
      world.step();
      const world::LinkState link = state_of(world).links.back();
      EXPECT_NEAR(link.velocity.x(), -2.5, 1e-6) << hz << ' ' << gap;
      EXPECT_NEAR(link.velocity.y(), 3, 1e-6) << hz << ' ' << gap;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
