// SPDX-License-Identifier: MIT
// Pendulums, chains, limits and motors.

#include <gtest/gtest.h>

#include <algorithm>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Links hung on each other by revolute joints about y, assembled stretched out along x.
scene::Entity hanging_chain(int count, double length, double mass, double last_mass) {
  const scene::Box rod{{length, length / 10, length / 10}};
  std::vector<scene::Link> links{link("base", scene::Box{{0.01, 0.01, 0.01}}, 1)};
  for (int i = 0; i < count; ++i) {
    links.push_back(link("l" + std::to_string(i), rod, i + 1 < count ? mass : last_mass));
  }
  scene::Entity entity = prototype("chain", at(0, 0, 50), false, links);
  for (int i = 0; i < count; ++i) {
    const double z = length / 20;  // a rod's frame is at the middle of its lower face
    scene::Joint next = joint(scene::JointType::revolute, Vector3::UnitY(),
                              i == 0 ? at(0, 0, 0) : at(length / 2, 0, z), at(-length / 2, 0, z));
    next.id = "j" + std::to_string(i);
    next.parent = i;
    next.child = i + 1;
    entity.joints.push_back(next);
  }
  return entity;
}

/// The same, hung above a heavy base that stands on the floor.
scene::Entity standing_chain(int count, double length, double mass) {
  scene::Entity entity = hanging_chain(count, length, mass, mass);
  entity.movable = true;
  entity.pose = at(0, 0, 0);
  entity.links[0] = link("base", scene::Box{{0.6, 0.6, 0.1}}, 500);
  entity.joints[0].parent_frame = at(0, 0, 1);
  return entity;
}

double worst_energy_error(int links, double seconds, double h, bool stands = false) {
  World world(newton(stands), h);
  world.add(stands ? standing_chain(links, 0.2, 0.3) : hanging_chain(links, 0.2, 0.3, 0.3));
  const double start = world.energy();
  const double swing = earth * 0.3 * links * 0.2 * links / 2;  // what falls
  double worst = 0;
  for (int i = 0; i < seconds / h; ++i) {
    world.step();
    worst = std::max(worst, std::abs(world.energy() - start) / swing);
  }
  return worst;
}

TEST(NewtonChain, DoublePendulumKeepsItsEnergyAtAnySubstep) {
  for (const double hz : long_runs::substep_rates()) {
    EXPECT_LT(worst_energy_error(2, 10, 1 / hz), 1e-3) << hz;
  }
}

TEST(NewtonChain, OfTenKeepsItsEnergyAtAnySubstep) {
  for (const double hz : long_runs::substep_rates()) {
    EXPECT_LT(worst_energy_error(10, 2, 1 / hz), 1e-2) << hz;
  }
}

// A substep with contacts is of first order: what falls at v is about h v / 2 from where it should
// be.
TEST(NewtonChain, KeepsItsEnergyOnABaseThatStands) {
  for (const int links : {1, 2, 4}) {
    for (const double hz : long_runs::substep_rates({.first = 100})) {
      EXPECT_LT(worst_energy_error(links, 10, 1 / hz, true), 10 / hz) << links << " " << hz;
    }
  }
}

TEST(NewtonChain, OfLightLinksCarriesAHundredKilograms) {
  constexpr int count = long_runs::links_of_a_chain;
  constexpr double length = 1.0 / count;
  for (const double hz : long_runs::first_of({100, 1000})) {
    const double h = 1 / hz;
    World world(newton(), h);
    scene::Entity entity = hanging_chain(count, length, 0.01, 100);
    world.add(entity);
    double fastest = 0;
    for (int i = 0; i < 0.9 / h; ++i) {
      world.step();
      const world::State state = state_of(world);
      fastest = std::max(fastest, state.links.back().velocity.norm());
    }
    // A point in the middle of the last link, l from the first joint, would reach sqrt(2 g l).
    const double expected = std::sqrt(2 * earth * (1 - length / 2));
    EXPECT_NEAR(fastest, expected, 0.05 * expected) << h;
  }
}

// Nothing holds it there: it stayed outside.
TEST(NewtonLimit, TakesInAJointThatBeginsOutside) {
  World world(newton(false, 0), 0.01);
  scene::Joint rail = joint(scene::JointType::prismatic, Vector3::UnitZ(), {}, {});
  rail.limit = scene::JointLimit{0.1, 0.2};
  scene::Entity entity = prototype(
      "slide", at(0, 0, 5), false,
      {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1), link("load", scene::Box{{0.1, 0.1, 0.1}}, 1)});
  entity.joints.push_back(rail);
  world.add(entity);
  run(world, 1, 0.01);
  EXPECT_NEAR(world.position(world.joint(0, 0)), 0.1, 1e-5);
  EXPECT_NEAR(world.velocity(world.joint(0, 0)), 0, 1e-9);
}

TEST(NewtonLimit, StopsAHeavyFall) {
  for (const double mass : {1.0, 100.0, 1000.0}) {
    World world(newton(), 0.01);
    scene::Joint rail = joint(scene::JointType::prismatic, Vector3::UnitZ(), {}, {});
    rail.limit = scene::JointLimit{-2, 1};
    scene::Entity entity = prototype("lift", at(0, 0, 5), false,
                                     {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                      link("load", scene::Box{{0.1, 0.1, 0.1}}, mass)});
    entity.joints.push_back(rail);
    world.add(entity);
    const JointIndex index = world.joint(0, 0);
    double lowest = 0, rebound = -2;
    for (int i = 0; i < 200; ++i) {
      world.step();
      lowest = std::min(lowest, world.position(index));
      if (i > 70) rebound = std::max(rebound, world.position(index));
    }
    EXPECT_GT(lowest, -2 - 1e-3) << mass;
    EXPECT_LT(rebound, -2 + 1e-3) << mass;
  }
}

// A joint that Coriolis forces drive to its limit within a substep passed it by up to 0.04 rad.
TEST(NewtonLimit, HoldsLinksThatAreThrownOnIt) {
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    World world(newton(), 1 / hz);
    scene::Entity chain = hanging_chain(5, 0.2, 0.2, 0.2);
    const double limit = 20 * M_PI / 180;
    for (std::size_t i = 1; i < 5; ++i) chain.joints[i].limit = scene::JointLimit{-limit, limit};
    world.add(chain);
    double over = 0;
    for (int i = 0; i < 4 * hz; ++i) {
      world.step();
      for (std::size_t k = 1; k < 5; ++k)
        over = std::max(over, std::abs(world.position(world.joint(0, k))) - limit);
    }
    EXPECT_LT(over, 1e-6) << hz;
  }
}

TEST(NewtonFall, OfAPrototypeIsExact) {
  for (const double h : {0.02, 0.01, 0.001}) {
    World world(newton(), h);
    scene::Entity entity = loose(at(0, 0, 100), scene::Box{{0.1, 0.1, 0.1}}, 1);
    entity.links[0].damping = {0.04, 0.04, true, true};  // the dialect's default
    world.add(entity);
    run(world, 3, h);
    EXPECT_NEAR(origin(world, 0).position.z(), 100 - earth * 4.5, 1e-9) << h;
  }
}

TEST(NewtonFall, IsDampedAsTheSceneSaysAndUnderTheSlowClock) {
  scene::Entity entity = loose(at(0, 0, 100), scene::Box{{0.1, 0.1, 0.1}}, 1);
  entity.links[0].damping = {0.04, 0.04, true, true};
  scene::Physics slow = newton();
  slow.clock = scene::Clock::beta50;
  World first(slow, 0.001);
  first.add(entity);
  entity.links[0].damping = {0.04, 0.04};
  World second(newton(), 0.001);
  second.add(entity);
  run(first, 3, 0.001);
  run(second, 3, 0.001);
  // dv/dt = earth - k v (1 + v), by the midpoint rule in fine steps.
  const double k = 0.04;
  double v = 0, z = 100;
  for (int i = 0; i < 30000; ++i) {
    const double middle = v + 5e-5 * (earth - k * v * (1 + v));
    v += 1e-4 * (earth - k * middle * (1 + middle));
    z -= 1e-4 * middle;
  }
  EXPECT_NEAR(origin(first, 0).position.z(), z, 0.02);
  EXPECT_EQ(origin(first, 0).position, origin(second, 0).position);
}

/// A robot of 1.12 kg on two driven wheels, with a smooth ball before and one behind them.
struct Wheels {
  double radius = 0.02, width = 0.005, track = 0.06;  // [m]
  double ball = 0.005, arm = 0.04;                    // radius, and distance from the middle [m]
};

scene::Entity two_wheeler(const Wheels& size = {}) {
  std::vector<scene::Link> links{
      link("base", scene::Box{{2.5 * size.arm, 0.8 * size.track, 4 * size.ball}}, 1)};
  links[0].surface.friction = 0;
  for (const char* id : {"left", "right"}) {
    links.push_back(link(id, scene::Cylinder{size.radius, size.width}, 0.05));
    links.back().surface.friction = 1;
  }
  for (const char* id : {"front", "back"}) {
    links.push_back(link(id, scene::Sphere{size.ball}, 0.01));
    links.back().surface.friction = 0;
  }
  const double above = 2 * size.ball;  // of the base over the floor
  links[0].offset = at(0, 0, above);
  scene::Entity entity = prototype("robot", at(0, 0, 0), true, links);
  for (int i = 0; i < 4; ++i) {
    const bool wheel = i < 2;
    const math::Pose side{{0, (i == 0 ? 0.5 : -0.5) * size.track, size.radius - above},
                          about(Vector3::UnitX(), -M_PI / 2)};
    const math::Pose below = at(i == 2 ? size.arm : -size.arm, 0, size.ball - above);
    scene::Joint next =
        joint(wheel ? scene::JointType::revolute : scene::JointType::fixed, Vector3::UnitZ(),
              wheel ? side : below, at(0, 0, wheel ? size.width / 2 : size.ball));
    next.id = links[i + 1].id;
    next.child = i + 1;
    entity.joints.push_back(next);
  }
  return entity;
}

/// Adds the two-wheeler's motors. @param left, right  [rad/s]
void drive(World& world, double max_impulse, double left, double right) {
  for (std::size_t i = 0; i < 2; ++i) {
    world.add_motor(world.joint(0, i), scene::JointMode::velocity, max_impulse);
    world.set_target(world.joint(0, i), i == 0 ? left : right);
  }
}

// Five supports for three directions: where loads are not shared, wheels spin on the spot.
TEST(NewtonWheels, DriveBetweenTwoSmoothBalls) {
  const double wheel = 0.02, torque = 0.02, speed = 0.2, seconds = 1;
  const double inertia = 0.05 * wheel * wheel / 2;
  const double gain = 2 * torque / wheel / (1.12 + 2 * inertia / (wheel * wheel));  // [m/s^2]
  for (const double hz : long_runs::substep_rates()) {
    scene::Physics physics = newton(true);
    physics.floor->surface.friction = 1;
    World world(physics, 1 / hz);
    world.add(two_wheeler());
    drive(world, torque / hz, speed / wheel, speed / wheel);
    run(world, seconds, 1 / hz);
    EXPECT_NEAR(state_of(world).links[0].velocity.x(), speed, 1e-8) << hz;
    EXPECT_NEAR(origin(world, 0).position.x(), speed * (seconds - speed / gain / 2), speed / hz)
        << hz;
  }
}

// A wheel stands on the two ends of a line. The balls rub, so wheels must push: their outer ends
// roll, and the inner ones, which are faster, slide. Where loads are shared at random the robot
// turns about other points, or stands on the balls while its wheels spin.
TEST(NewtonWheels, ShareTheirLoadsWhateverTheSubstep) {
  const double wheel = 0.02, track = 0.06, width = 0.005, seconds = 4;
  scene::Entity robot = two_wheeler();
  for (std::size_t i = 3; i < 5; ++i) robot.links[i].surface.friction = 0.3;
  for (const auto& [left, right] : {std::pair(10.0, 5.0), {5.0, 2.0}, {4.0, -4.0}}) {
    for (const double hz : long_runs::substep_rates()) {
      scene::Physics physics = newton(true);
      physics.floor->surface.friction = 0.7;
      World world(physics, 1 / hz);
      world.add(robot);
      drive(world, 0.02 / hz, left, right);
      run(world, seconds, 1 / hz);
      const world::LinkState base = state_of(world).links[0];
      EXPECT_NEAR(base.angular_velocity.z(), (right - left) * wheel / (track + width), 1e-6)
          << left << ' ' << hz;
      EXPECT_NEAR(base.velocity.norm(), (right + left) * wheel / 2, 1e-6) << left << ' ' << hz;
    }
  }
}

// Wheels that drive nearly straight: the ends of a wheel's line slide by some 1e-4 m/s. Newton's
// method cycled, because contact points of rolling bodies were new ones after 5 mm. Then smooth
// balls carried all of the weight for seconds. The wheels carry 4 of 6 points.
TEST(NewtonWheels, CarryTheirShareAlsoWhereTheyHardlySlide) {
  const Wheels size{0.03, 0.01, 0.12, 0.01, 0.065};
  for (const auto& [left, right] : {std::pair(20., 20.05), {36.8, 36.9}, {3., 3.3}}) {
    for (const double hz : long_runs::substep_rates()) {
      SCOPED_TRACE(::testing::Message() << left << ' ' << right << " rad/s at " << hz);
      scene::Physics physics = newton(true);
      physics.floor->surface.friction = 1;
      World world(physics, 1 / hz);
      world.add(two_wheeler(size));
      drive(world, 1 / hz, left, right);
      std::vector<world::Contact> contacts;
      for (int i = 0; i < 20; ++i) {
        run(world, 0.1, 1 / hz);
        world.list_contacts(contacts);
        double all = 0, of_wheels = 0;
        for (const world::Contact& contact : contacts) {
          all += contact.force.z();
          of_wheels += contact.link == 1 || contact.link == 2 ? contact.force.z() : 0;
        }
        if (i > 4) {
          EXPECT_NEAR(of_wheels / all, 4.0 / 6, 0.02);
        }
      }
      EXPECT_NEAR(state_of(world).links[0].angular_velocity.z(),
                  (right - left) * size.radius / (size.track + size.width), 1e-3 * (right - left));
    }
  }
}

// 1 m/s on a circle of 0.5 m: the outer side presses, but neither side lifts. At 50 Hz a substep
// takes it 2 cm on.
TEST(NewtonWheels, DriveAFastCircleBetweenTwoSmoothBalls) {
  const double wheel = 0.02, track = 0.06, speed = 0.5, radius = 0.5, seconds = 4;
  for (const double hz : long_runs::substep_rates()) {
    scene::Physics physics = newton(true);
    physics.floor->surface.friction = 1;
    World world(physics, 1 / hz);
    world.add(two_wheeler());
    const double middle = speed / wheel, more = middle * track / 2 / radius;
    drive(world, 0.5 / hz, middle - more, middle + more);
    run(world, seconds, 1 / hz);
    const world::LinkState base = state_of(world).links[0];
    EXPECT_NEAR(base.velocity.norm(), speed, 2e-3 * speed) << hz;
    // Smooth balls ask for no push: the wheel rolls about any point between its ends.
    EXPECT_NEAR(base.angular_velocity.z(), speed / radius, 0.09 * speed / radius) << hz;
  }
}

// Four feet carry a quarter of the weight each, whatever came before and whichever way the table
// looks.
TEST(NewtonTable, RestsOnItsFourFeetAlike) {
  scene::Entity table =
      prototype("table", at(0, 0, 0.005), true, {link("top", scene::Box{{0.4, 0.3, 0.02}}, 1)});
  table.links[0].offset = at(0, 0, 0.1);
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.18 : -0.18, y = i % 2 == 0 ? 0.13 : -0.13;
    table.links.push_back(link("foot" + std::to_string(i), scene::Sphere{0.05}, 0.1));
    scene::Joint fixed =
        joint(scene::JointType::fixed, Vector3::UnitZ(), at(x, y, 0), at(0, 0, 0.1));
    fixed.id = table.links.back().id;
    fixed.child = i + 1;
    table.joints.push_back(fixed);
  }
  for (const double heading : {0.0, 0.5, 2.0}) {
    for (const double hz : long_runs::substep_rates()) {
      World world(newton(true), 1 / hz);
      table.pose.orientation = about(Vector3::UnitZ(), heading);
      world.add(table);
      run(world, 1, 1 / hz);
      std::vector<world::Contact> contacts;
      world.list_contacts(contacts);
      ASSERT_EQ(contacts.size(), 4u) << heading << ' ' << hz;
      for (const world::Contact& contact : contacts) {
        EXPECT_NEAR(contact.force.z(), 1.4 * earth / 4, 1e-3) << heading << ' ' << hz;
      }
    }
  }
}

// It stops with all that it has: what is left of its energy is rounding.
TEST(NewtonArm, ThatStrikesAPlateStaysANumber) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(), 1 / hz);
    scene::Entity arm = prototype("arm", at(0, 0, 0), false,
                                  {link("base", scene::Box{{0.05, 0.05, 0.05}}, 1),
                                   link("rod", scene::Box{{0.3, 0.02, 0.02}}, 0.2)});
    arm.joints.push_back(
        joint(scene::JointType::revolute, Vector3::UnitY(), at(0, 0.2, 0.1), at(-0.15, 0, 0.01)));
    world.add(arm);
    world.add(standing(at(0.3, 0.2, 0.02), scene::Box{{0.2, 0.2, 0.05}}));
    world.add_motor(world.joint(0, 0), scene::JointMode::position, 1.5 / hz);
    world.set_target(world.joint(0, 0), 1);
    run(world, 1, 1 / hz);
    EXPECT_NEAR(world.velocity(world.joint(0, 0)), 0, 1e-9) << hz;
    EXPECT_GT(world.position(world.joint(0, 0)), 0.05) << hz;
  }
}

TEST(NewtonMotor, HoldsItsSpeedWithinItsImpulse) {
  const double h = 0.01, mass = 2;
  World world(newton(false, 0), h);
  scene::Entity entity = prototype("slider", at(0, 0, 0), false,
                                   {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                    link("load", scene::Box{{0.1, 0.1, 0.1}}, mass)});
  entity.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitX(), {}, {}));
  world.add(entity);
  const JointIndex index = world.joint(0, 0);
  world.add_motor(index, scene::JointMode::velocity, 0.02);
  world.set_target(index, 0.5);
  run(world, 0.3, h);
  EXPECT_NEAR(world.velocity(index), 30 * 0.02 / mass, 1e-9);
  run(world, 0.5, h);
  EXPECT_NEAR(world.velocity(index), 0.5, 1e-9);
}

// Up to a fifth of it was lost, as the energy that Coriolis forces of the slide that stops seemed
// to have given.
TEST(NewtonLimit, KeepsAngularMomentumOfAFloatingSlide) {
  const double inertia = 2.0 / 3 * (0.3 * 0.3 + 0.1 * 0.1) + 2.0 / 12 * (0.04 + 0.01) +
                         1.0 / 12 * (0.01 + 0.0025);  // at its limit
  for (const double hz : long_runs::substep_rates()) {
    for (const double speed : {0.53, 3.1, 20.0}) {
      World world(newton(false, 0), 1 / hz);
      scene::Entity slide = prototype(
          "slide", at(0, 0, 0), true,
          {link("a", scene::Box{{0.2, 0.1, 0.1}}, 2), link("b", scene::Box{{0.1, 0.05, 0.05}}, 1)});
      slide.joints.push_back(
          joint(scene::JointType::prismatic, Vector3::UnitX(), at(0, 0.1, 0.05), at(0, 0, 0.025)));
      slide.joints.back().limit = scene::JointLimit{-0.1, 0.3};
      world.add(slide);
      const world::Push push{1, Vector3(hz * speed, 0, 0), Vector3::Zero()};
      set_pushes(world, std::span(&push, 1));
      world.step();
      set_pushes(world, {});
      run(world, 1, 1 / hz);
      EXPECT_NEAR(state_of(world).links[0].angular_velocity.z(), -speed * 0.2 / 3 / inertia,
                  1e-5 * speed)
          << hz << ' ' << speed;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
