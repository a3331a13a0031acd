// What lies on a turning table, and what rolls on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

// Velocities are those at the substep's beginning: along them it would go outwards by a share of (w h)^2 / 2 in each.
TEST(NewtonTurntable, CarriesABoxInACircle) {
  const double radius = 0.2, speed = 2, seconds = 10;
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    World world(newton(), 1 / hz);
    scene::Entity table = prototype("table", at(0, 0, 0), false,
                                    {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1), link("disc", scene::Cylinder{0.4, 0.02}, 5)});
    table.joints.push_back(joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0.2), at(0, 0, 0)));
    world.add(with_friction(table, 1));
    world.add(loose(at(radius, 0, 0.22), scene::Box{{0.05, 0.05, 0.02}}, 0.2, 1));
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 0.5 / hz);
    world.set_target(world.joint(0, 0), speed);
    run(world, seconds, 1 / hz);
    EXPECT_NEAR(world.velocity(world.joint(0, 0)), speed, 1e-6) << hz;
    EXPECT_NEAR(std::hypot(origin(world, 1).position.x(), origin(world, 1).position.y()), radius, 1e-3 * radius) << hz;
  }
}

// The ball's centre goes round in a circle with 2/7 of the table's speed; one that is still stays where it is, and drifted inwards:
// its point of contact is not that of its material.
TEST(NewtonTurntable, LetsABallRollInACircle) {
  const double radius = 0.05, mass = 0.2, turning = 10, from = 0.1;
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    for (const double speed : {0.0, 0.3}) {
      World world(newton(), 1 / hz);
      scene::Entity table = prototype("table", at(0, 0, 0), false,
                                      {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1), link("disc", scene::Cylinder{2, 0.05}, 20)});
      table.joints.push_back(joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0.2), at(0, 0, 0)));
      world.add(with_friction(table, 1));
      world.add(loose(at(from, 0, 0.25), scene::Sphere{radius}, mass, 1));
      world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e6 / hz);
      world.set_target(world.joint(0, 0), turning);
      const double inertia = 0.4 * mass * radius * radius * hz;
      const world::Push push{2, Vector3(mass * speed * hz, 0, 0), Vector3(inertia * turning * from / radius, inertia * speed / radius, 0)};
      set_pushes(world, std::span(&push, 1));
      world.step();
      set_pushes(world, {});
      const double rate = 2 * turning / 7, circle = speed / rate;
      double worst = 0;
      for (int i = 1; i < 2 * hz; ++i) {
        world.step();
        const Vector3 exact(from + circle * std::sin(rate * i / hz) + speed / hz, circle * (1 - std::cos(rate * i / hz)), 0.25 + radius);
        worst = std::max(worst, (origin(world, 1) * Vector3(0, 0, radius) - exact).norm());
      }
      EXPECT_LT(worst, speed > 0 ? 0.7 / hz : 1e-5) << hz << ' ' << speed;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
