// SPDX-License-Identifier: MIT
// Motors, pushes and impacts that accelerate a body within a substep: it stops at its obstacles.

#include <gtest/gtest.h>

#include <cmath>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

scene::Entity wall_of(double near, double thickness) {
  return standing(at(near + thickness / 2, 0, -0.5), scene::Box{{thickness, 1, 1}}, 1);
}

/// A head of 4 cm on a slide along x, whose front is at x = 0.
scene::Entity slide(double mass) {
  scene::Entity entity = prototype("slide", at(-0.02, 0, 0), false,
                                   {link("base", scene::Box{{0.01, 0.01, 0.01}}, 1),
                                    link("head", scene::Box{{0.04, 0.04, 0.04}}, mass)});
  entity.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitX(), at(0, 0, 0), {}));
  return entity;
}

// It was through the wall at 100 Hz, because its reach was that of its speed at the beginning, 0.
TEST(NewtonThrown, AMotorStopsAtAThinWall) {
  for (const double hz : long_runs::substep_rates({.first = 100})) {
    for (const double gap : {0.005, 0.02, 0.035}) {
      World world(newton(false), 1 / hz);
      world.add(slide(0.05));
      world.add(wall_of(gap, 0.005));
      world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 50 / hz);
      world.set_target(world.joint(0, 0), 2);
      for (int i = 0; i < hz / 2; ++i) {
        world.step();
        ASSERT_LT(world.position(world.joint(0, 0)), gap + 1e-4) << hz << ' ' << gap;
      }
      EXPECT_NEAR(world.position(world.joint(0, 0)), gap, 1e-5) << hz << ' ' << gap;
    }
  }
}

// An arm went through a post, because what it may touch was looked for along a straight way.
TEST(NewtonThrown, AnArmStopsAtAPost) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double speed : {10, 60, 150}) {
      for (const double angle : {0.6, 1.7, 2.9}) {
        World world(newton(false, 0), 1 / hz);
        scene::Entity arm = prototype("arm", at(0, 0, 0), false,
                                      {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1),
                                       link("arm", scene::Box{{0.2, 0.02, 0.02}}, 0.02)});
        arm.joints.push_back(
            joint(scene::JointType::revolute, Vector3::UnitZ(), at(0, 0, 0), at(-0.1, 0, 0)));
        world.add(arm);
        world.add(standing(at(0.15 * std::cos(angle), 0.15 * std::sin(angle), -0.5),
                           scene::Cylinder{0.01, 1}));
        world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 20 / hz);
        world.set_target(world.joint(0, 0), speed);
        const double touch = angle - std::asin(0.02 / 0.15);
        for (int i = 0; i < hz; ++i) {
          world.step();
          ASSERT_LT(world.position(world.joint(0, 0)), touch + 1e-3)
              << hz << ' ' << speed << ' ' << angle;
        }
        EXPECT_NEAR(world.position(world.joint(0, 0)), touch, 1e-4)
            << hz << ' ' << speed << ' ' << angle;
      }
    }
  }
}

// Only the bound that was nearer at the substep's beginning held: the head passed the other by up
// to metres.
TEST(NewtonThrown, AMotorStopsAtItsLimit) {
  for (const double hz : long_runs::substep_rates()) {
    for (const bool floats : {false, true}) {
      for (const double force : {10, 100}) {
        World world(newton(false, 0), 1 / hz);
        scene::Entity robot = slide(0.02);
        robot.movable = floats;
        robot.joints[0].limit = {0, 0.05};
        world.add(robot);
        world.add_motor(world.joint(0, 0), scene::JointMode::position, force / hz);
        world.set_target(world.joint(0, 0), 0.2);
        for (int i = 0; i < hz; ++i) {
          world.step();
          ASSERT_LT(world.position(world.joint(0, 0)), 0.05 + 1e-6) << hz << ' ' << force;
        }
        EXPECT_NEAR(world.position(world.joint(0, 0)), 0.05, 1e-6) << hz << ' ' << force;
      }
    }
  }
}

// Two with magnets take the substep in parts, in which nothing was foreseen: the head passed the
// block and the wall.
TEST(NewtonThrown, AMotorWithAMagnetStopsAtABlockWithAMagnet) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double mass : {0.002, 0.02}) {
      scene::Physics physics = newton(false, 0);
      physics.magnetism = scene::Magnetism{};
      World world(physics, 1 / hz);
      const auto with_magnet = [](scene::Entity entity, std::size_t link) {
        scene::Magnet magnet;
        magnet.anchor.link = link;
        magnet.moment = {1, 0, 0};
        entity.devices.magnets.push_back(magnet);
        return entity;
      };
      world.add(with_magnet(slide(mass), 1));
      world.add(with_magnet(loose(at(0.04, 0, 0), scene::Box{{0.04, 0.04, 0.04}}, 0.1), 0));
      world.add(wall_of(0.0605, 0.01));
      world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 20 / hz);
      world.set_target(world.joint(0, 0), 1000);
      for (int i = 0; i < hz / 2; ++i) {
        world.step();
        ASSERT_LT(world.position(world.joint(0, 0)), 0.0205 + 1e-4) << hz << ' ' << mass;
      }
    }
  }
}

// Fingers of 20 g met within the block.
TEST(NewtonThrown, AGripperClosesOnABlock) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double force : {2, 5, 10, 20}) {
      World world(newton(true), 1 / hz);
      scene::Entity gripper = prototype("gripper", at(0, 0, 0.2), false,
                                        {link("palm", scene::Box{{0.01, 0.01, 0.01}}, 1)});
      for (const double side : {-1.0, 1.0}) {
        gripper.links.push_back(
            link(side < 0 ? "left" : "right", scene::Box{{0.02, 0.01, 0.04}}, 0.02));
        scene::Joint each = joint(scene::JointType::prismatic, -side * Vector3::UnitY(),
                                  at(0, side * 0.05, -0.2), {});
        each.child = gripper.links.size() - 1;
        gripper.joints.push_back(each);
      }
      world.add(gripper);
      world.add(loose(at(0, 0, 0), scene::Box{{0.03, 0.03, 0.03}}, 0.1, 0.5));
      run(world, 0.5, 1 / hz);  // the block sleeps
      for (int i = 0; i < 2; ++i) {
        world.add_motor(world.joint(0, i), scene::JointMode::position, force / hz);
        world.set_target(world.joint(0, i), 0.05);
      }
      run(world, 1, 1 / hz);
      for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(world.position(world.joint(0, i)), 0.03, 1e-4) << hz << ' ' << force;
    }
  }
}

TEST(NewtonThrown, WhatIsStruckStopsAtAWall) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double speed : {3, 10}) {
      World world(newton(false, 0), 1 / hz);
      world.add(loose(at(-0.5, 0, 0), scene::Box{{0.1, 0.1, 0.1}}, 1, 0));
      world.add(loose(at(0, 0, 0.03), scene::Box{{0.04, 0.04, 0.04}}, 0.05, 0));
      world.add(wall_of(0.04, 0.005));
      const world::Push push{0, Vector3(hz * speed, 0, 0), Vector3::Zero()};
      set_pushes(world, std::span(&push, 1));
      world.step();
      set_pushes(world, {});
      for (int i = 0; i < hz; ++i) {
        world.step();
        ASSERT_LT(origin(world, 1).position.x(), 0.02 + 1e-4) << hz << ' ' << speed;
      }
    }
  }
}

// A foot rebounds from the floor, the body above it still falls, and the limit of the slide between
// them jerks the foot down. It was up to 70 mm below the floor at the substep's end.
TEST(NewtonThrown, WhatALimitJerksDownStopsAtTheFloor) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double height : {0.3, 0.4, 0.5}) {
      World world(newton(true), 1 / hz);
      scene::Entity hopper = prototype("hopper", at(0, 0, height), true,
                                       {link("foot", scene::Box{{0.2, 0.2, 0.05}}, 0.2),
                                        link("body", scene::Box{{0.1, 0.1, 0.1}}, 1)});
      hopper.joints.push_back(
          joint(scene::JointType::prismatic, Vector3::UnitZ(), at(0, 0, 0.3), {}));
      hopper.joints[0].limit = {-0.005, 0.005};
      hopper.links[0].surface.restitution = 0.8;
      world.add(hopper);
      for (int i = 0; i < 0.6 * hz; ++i) {
        world.step();
        ASSERT_GT(origin(world, 0).position.z(), -5e-4) << hz << ' ' << height << ' ' << i;
      }
    }
  }
}

// A kicker reaches its speed at once, before it meets the ball: the ball left with v + e gap / h,
// 26 % less.
TEST(NewtonThrown, ABallReboundsFromAKickerThatIsSetInMotion) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(false, 0), 1 / hz);
    scene::Entity kicker = slide(0.2);
    kicker.links[1].surface.restitution = 0.5;
    world.add(kicker);
    world.add(loose(at(0.033, 0, 0), scene::Sphere{0.02}, 0.05, 0));
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e5 / hz);
    world.set_target(world.joint(0, 0), 3);
    run(world, 0.1, 1 / hz);
    EXPECT_NEAR(state_of(world).links[2].velocity.x(), 1.5 * 3, 4.5 * 0.5 / hz) << hz;
  }
}

TEST(NewtonThrown, APushStopsAtAWall) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(false, 0), 1 / hz);
    world.add(loose(at(0, 0, 0), scene::Box{{0.04, 0.04, 0.04}}, 0.1, 0));
    world.add(wall_of(0.05, 0.01));
    const world::Push push{0, Vector3(500, 0, 0), Vector3::Zero()};
    set_pushes(world, std::span(&push, 1));
    world.step();
    set_pushes(world, {});
    run(world, 0.5, 1 / hz);
    EXPECT_NEAR(origin(world, 0).position.x(), 0.03, 1e-4) << hz;
  }
}

// It rose by g h^2 / 2 in each substep, and through the ceiling: its speed at the end of each was
// none.
TEST(NewtonThrown, WhatAPushNearlyCarriesStaysBelowACeiling) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double share : {0.9, 0.99, 0.999, 1.0, 1.001, 1.5}) {
      World world(newton(false), 1 / hz);
      world.add(standing(at(0, 0, 0), scene::Box{{0.4, 0.4, 0.1}}));
      world.add(loose(at(0, 0, -0.01), scene::Box{{0.01, 0.01, 0.01}}, 0.0075));
      const world::Push push{1, Vector3(0, 0, share * 0.0075 * earth), Vector3::Zero()};
      set_pushes(world, std::span(&push, 1));
      for (int i = 0; i < hz; ++i) {
        world.step();
        ASSERT_LT(origin(world, 1).position.z(), -0.01 + 2e-6) << hz << ' ' << share << ' ' << i;
      }
      EXPECT_LT(std::abs(origin(world, 1).position.z() + 0.01), share < 1 ? 1 : 1e-5)
          << hz << ' ' << share;
    }
  }
}

// It slept after 0.3 s, with its motor running.
TEST(NewtonThrown, WhatAMotorMovesSlowlyDoesNotSleep) {
  for (const double speed : {3e-5, 3e-4}) {
    World world(newton(true), 0.01);
    scene::Entity robot = slide(0.05);
    robot.movable = true;
    world.add(robot);
    world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 0.5);
    world.set_target(world.joint(0, 0), speed);
    run(world, 10, 0.01);
    EXPECT_NEAR(world.position(world.joint(0, 0)), 10 * speed, 1e-3 * speed) << speed;
  }
}

}  // namespace
}  // namespace ziggurat::physics
