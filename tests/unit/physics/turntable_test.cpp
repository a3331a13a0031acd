// SPDX-License-Identifier: MIT
// Bodies on a turntable: lying, rolling, and carried round by its walls and slots.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

// Velocities are those at the substep's beginning: along them it would go outwards by a share of (w
// h)^2 / 2 in each.
TEST(NewtonTurntable, CarriesABoxInACircle) {
  const double radius = 0.2, speed = 2, seconds = 10;
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(), 1 / hz);
    scene::Entity table = prototype("table", at(0, 0, 0), false,
                                    {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                     link("disc", scene::Cylinder{0.4, 0.02}, 5)});
    table.joints.push_back(
        joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0.2), at(0, 0, 0)));
    world.add(with_friction(table, 1));
    world.add(loose(at(radius, 0, 0.22), scene::Box{{0.05, 0.05, 0.02}}, 0.2, 1));
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 0.5 / hz);
    world.set_target(world.joint(0, 0), speed);
    run(world, seconds, 1 / hz);
    EXPECT_NEAR(world.velocity(world.joint(0, 0)), speed, 1e-6) << hz;
    EXPECT_NEAR(std::hypot(origin(world, 1).position.x(), origin(world, 1).position.y()), radius,
                1e-3 * radius)
        << hz;
  }
}

// The ball's centre goes round in a circle with 2/7 of the table's speed; one that is still stays
// where it is, and drifted inwards: its point of contact is not that of its material.
TEST(NewtonTurntable, LetsABallRollInACircle) {
  const double radius = 0.05, mass = 0.2, turning = 10, from = 0.1;
  for (const double hz : long_runs::substep_rates()) {
    for (const double speed : {0.0, 0.3}) {
      World world(newton(), 1 / hz);
      scene::Entity table = prototype("table", at(0, 0, 0), false,
                                      {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                       link("disc", scene::Cylinder{2, 0.05}, 20)});
      table.joints.push_back(
          joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0.2), at(0, 0, 0)));
      world.add(with_friction(table, 1));
      world.add(loose(at(from, 0, 0.25), scene::Sphere{radius}, mass, 1));
      world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e6 / hz);
      world.set_target(world.joint(0, 0), turning);
      const double inertia = 0.4 * mass * radius * radius * hz;
      const world::Push push{
          2, Vector3(mass * speed * hz, 0, 0),
          Vector3(inertia * turning * from / radius, inertia * speed / radius, 0)};
      set_pushes(world, std::span(&push, 1));
      world.step();
      set_pushes(world, {});
      const double rate = 2 * turning / 7, circle = speed / rate;
      double worst = 0;
      for (int i = 1; i < 2 * hz; ++i) {
        world.step();
        const Vector3 exact(from + circle * std::sin(rate * i / hz) + speed / hz,
                            circle * (1 - std::cos(rate * i / hz)), 0.25 + radius);
        worst = std::max(worst, (origin(world, 1) * Vector3(0, 0, radius) - exact).norm());
      }
      EXPECT_LT(worst, speed > 0 ? 0.7 / hz : 1e-5) << hz << ' ' << speed;
    }
  }
}

/// A part of the table that another link carries. Its frame is at the middle of its lower face.
void fix(scene::Entity& entity, std::size_t parent, std::size_t child, const Pose& place) {
  scene::Joint next = joint(scene::JointType::fixed, Vector3::UnitZ(), place, at(0, 0, 0));
  next.id = "fixed" + std::to_string(child);
  next.parent = parent;
  next.child = child;
  entity.joints.push_back(next);
}

// The wall rotated and the ball moved straight. So it stood in the wall by 1.27 r (w h)^2 / 2 for
// good, and was through it from w h = 0.4 on.
TEST(NewtonTurntable, CarriesABallAlongItsWall) {
  const double turning = 10, radius = 0.05, from = 0.45, clearance = 1e-3;
  for (const double hz : long_runs::some_of({25, 50, 100, 200, 500, 1000})) {
    World world(newton(), 1 / hz);
    scene::Entity table = prototype("table", at(0, 0, 0), false,
                                    {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                     link("disc", scene::Cylinder{0.8, 0.05}, 5),
                                     link("wall", scene::Box{{0.05, 0.4, 0.2}}, 0.5),
                                     link("behind", scene::Box{{0.3, 0.05, 0.2}}, 0.5),
                                     link("before", scene::Box{{0.3, 0.05, 0.2}}, 0.5)});
    table.joints.push_back(
        joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0.2), at(0, 0, 0)));
    fix(table, 1, 2, at(from + radius + 0.025, 0, 0.05));
    fix(table, 1, 3, at(0.35, -radius - 0.025 - clearance, 0.05));
    fix(table, 1, 4, at(0.35, radius + 0.025 + clearance, 0.05));
    world.add(with_friction(table, 0));
    world.add(loose(at(from, 0, 0.25), scene::Sphere{radius}, 0.5, 0));
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e5 / hz);
    double worst = 0;
    for (int i = 1; i < 2 * hz; ++i) {
      world.set_target(world.joint(0, 0), turning * std::min(1.0, i / (0.5 * hz)));
      world.step();
      const Vector3 centre = origin(world, 1) * Vector3(0, 0, radius);
      worst = std::max(worst, std::hypot(centre.x(), centre.y()) - std::hypot(from, clearance));
    }
    EXPECT_LT(worst, from * std::pow(turning / hz, 3) / 2 + 1e-5) << hz;
  }
}

// A pendulum's bob in the slot of a slide. The slide was led along chords, and took 25 to 0.6 % of
// the energy at 50 to 2 000 Hz.
TEST(NewtonGuide, KeepsTheEnergyOfWhatASlotLeads) {
  const double length = 0.1, radius = 0.01, thickness = 0.02;
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    World world(newton(), 1 / hz);
    scene::Entity crank = prototype(
        "crank", at(0, 0.1, 1), false,
        {link("base", scene::Box{{0.01, 0.01, 0.01}}, 1), link("bob", scene::Sphere{radius}, 0.3)});
    crank.joints.push_back(joint(scene::JointType::revolute, Vector3::UnitY(), at(0, -0.1, 0),
                                 at(-length, 0, radius)));
    world.add(with_friction(crank, 0));
    scene::Entity slide = prototype("slide", at(0, -0.1, 1), false,
                                    {link("base", scene::Box{{0.01, 0.01, 0.01}}, 1),
                                     link("left", scene::Box{{thickness, 0.02, 0.6}}, 0.5),
                                     link("right", scene::Box{{thickness, 0.02, 0.6}}, 0.5)});
    slide.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitX(),
                                 at(length - radius - thickness / 2, 0.1, 0), at(0, 0, 0.3)));
    fix(slide, 1, 2, at(2 * radius + thickness, 0, 0));
    world.add(with_friction(slide, 0));
    double least = 1, most = -1;  // of the crank's angle, in the last of 4 s [rad]
    for (int i = 0; i < 4 * hz; ++i) {
      world.step();
      if (i < 2.5 * hz) continue;
      least = std::min(least, std::abs(world.position(world.joint(0, 0))));
      most = std::max(most, std::abs(world.position(world.joint(0, 0))));
    }
    EXPECT_NEAR(least, 0, 3.5 / hz) << hz;
    EXPECT_NEAR(most, std::numbers::pi, 3.5 / hz) << hz;
  }
}

}  // namespace
}  // namespace ziggurat::physics
