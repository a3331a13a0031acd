// SPDX-License-Identifier: MIT
// Collisions in flight: Galilean invariance, independence of the order of listing, and spin by
// friction.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

scene::Entity ball(double radius, double mass, const Vector3& position,
                   const scene::Surface& surface) {
  scene::Entity entity = loose({position, math::Quaternion::Identity()}, scene::Sphere{radius},
                               mass, surface.friction);
  entity.links[0].surface = surface;
  return entity;
}

/// Gives bodies, each of one link, velocities in one substep.
/// @param momenta  [N s]
void push_off(World& world, double hz, std::vector<Vector3> momenta) {
  std::vector<world::Push> pushes;
  for (std::size_t i = 0; i < momenta.size(); ++i)
    pushes.push_back({i, hz * momenta[i], Vector3::Zero()});
  set_pushes(world, pushes);
  world.step();
  set_pushes(world, {});
}

/// Two balls after an oblique blow, as seen by who moves with them.
std::vector<Vector3> after_a_blow(double hz, const Vector3& train) {
  World world(newton(false, 0), 1 / hz);
  world.add(ball(0.03, 0.2, {-0.2, 0.01, 0}, {.friction = 0.5, .restitution = 0.5}));
  world.add(ball(0.03, 0.2, {0, 0, 0}, {.friction = 0.5, .restitution = 0.5}));
  push_off(world, hz, {0.2 * (train + Vector3(1, 0, 0)), 0.2 * train});
  run(world, 0.4, 1 / hz);
  std::vector<Vector3> out;
  for (const auto& link : state_of(world).links) {
    out.push_back(link.velocity - train);
    out.push_back(link.angular_velocity);
  }
  return out;
}

// Angular momentum was kept about where a ball had been: what rebounds does not move along its
// velocity, so it got spin.
TEST(NewtonCollision, IsTheSameOnATrain) {
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    const auto resting = after_a_blow(hz, Vector3::Zero()), moving = after_a_blow(hz, {0, 3, -1});
    for (std::size_t i = 0; i < resting.size(); ++i)
      EXPECT_LT((resting[i] - moving[i]).norm(), 1e-9) << hz << ' ' << i;
  }
}

TEST(NewtonCollision, WithASmoothFloorGivesNoSpin) {
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    World world(newton(true, 0), 1 / hz);
    world.add(ball(0.02, 0.1, {0, 0, 0.073}, {.friction = 0, .restitution = 1}));
    push_off(world, hz, {{0.1, 0, -0.1}});
    run(world, 0.15, 1 / hz);
    EXPECT_LT((state_of(world).links[0].velocity - Vector3(1, 0, 1)).norm(), 1e-9) << hz;
    EXPECT_LT(state_of(world).links[0].angular_velocity.norm(), 1e-9) << hz;
  }
}

/// The spin of a ball that strikes the middle of a plate, while it slides [rad/s].
double spin_from_a_plate(double hz, bool plate_first) {
  World world(newton(false, 0), 1 / hz);
  const scene::Entity plate = loose(at(0, 0, -0.02), scene::Box{{1, 1, 0.02}}, 1, 0.5);
  const scene::Entity striker = ball(0.02, 0.1, {-0.365, 0, 0.073}, {.friction = 0.5});
  world.add(plate_first ? plate : striker);
  world.add(plate_first ? striker : plate);
  const Vector3 momentum(0.5, 0, -0.1), none(0, 0, 0);
  push_off(world, hz, plate_first ? std::vector{none, momentum} : std::vector{momentum, none});
  run(world, 0.15, 1 / hz);
  return state_of(world).links[plate_first].angular_velocity.y();
}

// Levers were about a point half-way between the surfaces of the substep's beginning: 7 cm off at
// 50 Hz.
TEST(NewtonCollision, GivesTheSpinOfFrictionInAnyOrder) {
  const double impulse = 1 / (1 / 0.1 + 1 / 1.0), expected = 2.5 * 0.25 * impulse / (0.1 * 0.02);
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    const double first = spin_from_a_plate(hz, true);
    EXPECT_NEAR(first, expected, 0.1 / hz * expected) << hz;
    EXPECT_NEAR(first, spin_from_a_plate(hz, false), 1e-6 * expected) << hz;
  }
}

// The normal was that of up to a millimetre before the touch: up to 9 % off at 50 Hz, and 2 % from
// 200 Hz on.
TEST(NewtonCollision, GoesAlongTheLineOfCentres) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double radius : {0.01, 0.05}) {
      for (int phase = 0; phase < 8; ++phase) {
        World world(newton(false, 0), 1 / hz);
        const scene::Surface smooth{.friction = 0, .restitution = 1};
        world.add(ball(radius, 0.1, {-0.2 - 0.0123 * phase, 0, 0}, smooth));
        world.add(ball(radius, 0.1, {0, 1.2 * radius, 0}, smooth));  // so the normal is (0.8, 0.6)
        push_off(world, hz, {{0.1, 0, 0}, {0, 0, 0}});
        run(world, 0.5, 1 / hz);
        EXPECT_LT((state_of(world).links[0].velocity - Vector3(0.36, -0.48, 0)).norm(), 1e-5)
            << hz << ' ' << radius << ' ' << phase;
        EXPECT_LT((state_of(world).links[1].velocity - Vector3(0.64, 0.48, 0)).norm(), 1e-5)
            << hz << ' ' << radius << ' ' << phase;
      }
    }
  }
}

// Newton's cradle. Speeds of all impacts of a substep were sought at once, so all balls moved.
TEST(NewtonCollision, GoesThroughARowOfBalls) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double gap : {0.0, 1e-4, 2e-3}) {
      World world(newton(false, 0), 1 / hz);
      std::vector<Vector3> momenta;
      for (int i = 0; i < 5; ++i) {
        world.add(ball(0.05, 0.1, {i == 0 ? -0.3 : (0.1 + gap) * i, 0, 0},
                       {.friction = 0.3, .restitution = 1}));
        momenta.push_back({i == 0 ? 0.1 : 0, 0, 0});
      }
      push_off(world, hz, momenta);
      run(world, 0.5, 1 / hz);
      const double start = -0.3 + 0.5 + 1 / hz - (0.1 + gap) * 4 +
                           0.4;  // of the last one, if the first were where it stops
      for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(state_of(world).links[i].velocity.x(), i == 4 ? 1 : 0, 1e-6)
            << hz << ' ' << gap << ' ' << i;
        const double end = i < 4 ? (0.1 + gap) * (i + 1) - 0.1 : (0.1 + gap) * 4 + start;
        EXPECT_NEAR(origin(world, i).position.x(), end, 1e-6) << hz << ' ' << gap << ' ' << i;
      }
    }
  }
}

// Fifty impacts in a substep of 20 ms, at 5 m/s and 2 mm. The ball went through the second wall.
TEST(NewtonCollision, GoesToAndFroBetweenTwoWalls) {
  for (const double hz : long_runs::substep_rates()) {
    for (const double room : {0.002, 0.01, 0.05}) {
      World world(newton(false, 0), 1 / hz);
      world.add(ball(0.02, 0.1, {0, 0, 0}, {.friction = 0, .restitution = 1}));
      for (const double side : {-1, 1})
        world.add(standing(at(side * (0.12 + room / 2), 0, -1), scene::Box{{0.2, 2, 2}}, 0));
      push_off(world, hz, {{0.5, 0, 0}});
      for (int i = 1; i < hz / 2; ++i) {
        const double way = room / 2 + 5 * i / hz, folds = std::floor(way / room),
                     rest = way - folds * room;
        const double expected = std::fmod(folds, 2) == 0 ? rest - room / 2 : room / 2 - rest;
        EXPECT_NEAR(origin(world, 0).position.x(), expected, 1e-6) << hz << ' ' << room << ' ' << i;
        world.step();
      }
    }
  }
}

// Smooth elastic balls in a smooth elastic box. Within the substep of a blow some energy may be
// missing.
TEST(NewtonCollision, OfAGasKeepsItsEnergy) {
  constexpr double radius = 0.05, mass = 0.1;
  constexpr scene::Surface smooth{.friction = 0, .restitution = 1};
  for (const double hz : long_runs::substep_rates({.least = 100, .most = 1000})) {
    World world(newton(false, 0), 1 / hz);
    std::mt19937 random(1);
    std::normal_distribution<double> speed(0, 0.6);
    std::vector<Vector3> momenta;
    for (int i = 0; i < 12; ++i) {
      world.add(ball(radius, mass,
                     {0.25 * (i % 3 - 1), 0.25 * (i / 3 % 2) - 0.12, 0.25 * (i / 6) - 0.12},
                     smooth));
      const double x = speed(random), y = speed(random);
      momenta.push_back(mass * Vector3(x, y, speed(random)));
    }
    for (const double side : {-1, 1}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vector3 size(2, 2, 2), place = Vector3::Zero();
        size[axis] = 0.2;
        place[axis] = side * 0.5;
        world.add(standing({place - Vector3(0, 0, size.z() / 2), math::Quaternion::Identity()},
                           scene::Box{size}, 0));
      }
    }
    push_off(world, hz, momenta);
    const double start = world.energy();
    double most = 0;
    for (int i = 0; i < 10 * hz; ++i) {
      world.step();
      if (i > 9.8 * hz) most = std::max(most, world.energy());
      ASSERT_LT(world.energy(), start * (1 + 1e-6)) << hz;
    }
    EXPECT_GT(most, start * (1 - 1 / hz))
        << hz;  // balls that meet two others in a substep lose some
  }
}

// A ball of 10 g on the floor is nipped by one of 10 kg. Its friction is more than tan(12.3
// degrees), so it rolls out below the other one. It went by up to 11 m in a substep, when its
// frictions alone were taken out of its displacement.
TEST(NewtonCollision, NipsALightBallWithoutThrowingIt) {
  for (const double hz : long_runs::substep_rates()) {
    scene::Physics physics = newton(true);
    physics.floor->surface.friction = 1;
    World world(physics, 1 / hz);
    world.add(ball(0.06, 0.01, {0, 0, 0}, {.friction = 0.8}));
    world.add(ball(0.06, 10, {0.05, 0.003, 0.62}, {.friction = 0.8}));
    const auto centre = [&] {
      return Vector3(state_of(world).links[0].pose * Vector3(0, 0, 0.06));
    };
    Vector3 before = centre();
    for (int i = 0; i < 0.46 * hz; ++i) {
      world.step();
      const Vector3 now = centre();
      ASSERT_LT((now - before).norm(), 0.6 / hz) << hz << ' ' << i;
      before = now;
    }
    EXPECT_NEAR(before.z(), 0.06, 1e-4) << hz;
    EXPECT_LT(before.head<2>().norm(), 0.06) << hz;
  }
}

// A body that turns was let fly where its contact seemed to do no more than push out what is
// pressed in; the other one got the impulse: 0.1 N s.
TEST(NewtonCollision, GivesOneWhatItTakesFromTheOther) {
  constexpr double height = 0.08;
  for (const double hz : long_runs::substep_rates({.least = 500})) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    for (unsigned heap = 0; heap < long_runs::runs(12, 4); ++heap) {
      World world(newton(false, 0), 1 / hz);
      std::vector<double> masses;
      std::vector<Vector3> momenta;
      for (int i = 0; i < 8; ++i) {
        const Vector3 place(0.2 * (i & 1), 0.1 * (i & 2), 0.05 * (i & 4));
        const Vector3 centre = place - Vector3(0.1, 0.1, 0.1);
        const double turn = 6 * share(random);
        masses.push_back(std::pow(10, -1 + 2 * share(random)));
        momenta.push_back(-10 * masses.back() * (centre + Vector3(0.02 * share(random), 0, 0)));
        const math::Quaternion turned(Eigen::AngleAxisd(turn, Vector3(1, 2, 3).normalized()));
        const scene::Geometry shape = i % 2 == 0 ? scene::Geometry(scene::Box{{0.1, 0.06, height}})
                                                 : scene::Cylinder{0.05, height};
        world.add(loose({centre, turned}, shape, masses.back(), 0.6));
      }
      const auto momentum = [&] {
        Vector3 sum = Vector3::Zero();
        const world::State now = state_of(world);
        for (std::size_t i = 0; i < masses.size(); ++i) {
          const world::LinkState& link = now.links[i];
          const Vector3 up = link.pose.orientation * Vector3(0, 0, height / 2);
          sum += masses[i] * (link.velocity + link.angular_velocity.cross(up));
        }
        return sum;
      };
      push_off(world, hz, momenta);
      const Vector3 before = momentum();
      for (int i = 0; i < 0.4 * hz; ++i) world.step();
      EXPECT_LT((momentum() - before).norm(), 1e-6) << hz << ' ' << heap;
    }
  }
}

// Contacts that came apart in the last part of a substep still report their impulse.
TEST(NewtonCollision, TellsTheContactOfAllThatIsPushed) {
  constexpr double height = 0.12, hz = 100;
  int pushed = 0;
  for (const unsigned heap : {10, 44, 227, 335}) {
    std::mt19937 random(heap);
    std::uniform_real_distribution<double> share(0, 1);
    World world(newton(true), 1 / hz);
    std::vector<double> masses;
    for (int i = 0; i < 8; ++i) {
      const double x = 0.24 * share(random) - 0.12, y = 0.24 * share(random) - 0.12,
                   turn = 6 * share(random);
      const math::Quaternion turned(
          Eigen::AngleAxisd(turn, Vector3(share(random), 1, 0.5).normalized()));
      masses.push_back(std::pow(10, -2 + 3 * share(random)));
      const scene::Geometry shape = i % 2 == 0 ? scene::Geometry(scene::Box{{0.1, 0.15, height}})
                                               : scene::Cylinder{0.05, height};
      world.add(loose({{x, y, 0.12 + 0.16 * i}, turned}, shape, masses.back(), 0.7));
    }
    const auto velocity = [&](std::size_t i) {
      const world::LinkState link = state_of(world).links[i];
      return Vector3(link.velocity + link.angular_velocity.cross(link.pose.orientation *
                                                                 Vector3(0, 0, height / 2)));
    };
    std::vector<Vector3> before(masses.size(), Vector3::Zero());
    std::vector<world::Contact> contacts;
    for (int step = 0; step < hz; ++step) {
      world.step();
      world.list_contacts(contacts);
      for (std::size_t i = 0; i < masses.size(); ++i) {
        const Vector3 now = velocity(i), change = hz * (now - before[i]) + earth * Vector3::UnitZ();
        before[i] = now;
        if (change.norm() < 0.1 * earth) continue;
        ++pushed;
        EXPECT_TRUE(std::ranges::any_of(
            contacts,
            [&](const world::Contact& contact) { return contact.link == i || contact.other == i; }))
            << heap << ' ' << step << ' ' << i << ": " << change.transpose();
      }
    }
  }
  EXPECT_GT(pushed, 1000);
}

// Ground friction of a body that slides in a plane: it stops after m v^2 / 2 F, whatever its
// heading.
TEST(NewtonPlaneFriction, IsTheSameInAllDirections) {
  constexpr double mass = 2, force = 1.49, speed = 1;
  for (const double degrees : {0, 15, 30, 45, 90}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vector3 direction(std::cos(angle), std::sin(angle), 0);
    World world(newton(false, 0), 0.001);
    scene::Entity body = loose(at(0, 0, 0), scene::Cylinder{0.1, 0.1}, mass);
    body.traction = scene::Traction{force, force};
    world.add(body);
    push_off(world, 1000, {mass * speed * direction});
    run(world, 2, 0.001);
    const Vector3 way = origin(world, 0).position;
    EXPECT_NEAR(way.norm(), mass * speed * speed / (2 * force), 3e-3) << degrees;
    EXPECT_LT((way.normalized() - direction).norm(), 1e-3) << degrees;
  }
}

}  // namespace
}  // namespace ziggurat::physics
