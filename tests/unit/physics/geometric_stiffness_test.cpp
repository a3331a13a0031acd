// SPDX-License-Identifier: MIT
// Chains of light links that pull: their tension comes from what touches them.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "../long_runs.h"
#include "newton_scene.h"
#include "physics/motors.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Adds a link behind the last one, by a revolute joint about y.
/// @param at_parent, at_child  the joint's place in both [m];  @param turn  of the child about y
/// [rad]
void append(scene::Entity& entity, const scene::Link& next, const Vector3& at_parent,
            const Vector3& at_child, double turn = 0) {
  const int parent = static_cast<int>(entity.links.size()) - 1;
  entity.links.push_back(next);
  entity.links.back().surface = {0, 0};
  scene::Joint hinge =
      joint(scene::JointType::revolute, Vector3::UnitY(),
            {at_parent, about(Vector3::UnitY(), turn)}, {at_child, math::Quaternion::Identity()});
  hinge.id = "j" + std::to_string(parent);
  hinge.parent = parent;
  hinge.child = parent + 1;
  entity.joints.push_back(hinge);
}

double fastest(const World& world) {
  double most = 0;
  for (const auto& link : state_of(world).links) most = std::max(most, link.velocity.norm());
  return most;
}

// Its tension of 98 N makes links of 10 g swing with up to 890 rad/s, that is 8.9 rad per substep
// at 100 Hz. Where they were pulled at the substep's beginning they are not at its end.
TEST(NewtonTension, OfAChainThatHoldsALoadOnASlope) {
  constexpr int count = 10;
  constexpr double length = 0.05, thick = 0.004, slope = std::numbers::pi / 6;
  for (const double hz : long_runs::substep_rates({.most = 1000})) {
    World world(newton(), 1 / hz);
    const math::Quaternion tilt = about(Vector3::UnitY(), slope);
    world.add(standing({tilt * Vector3(0, 0, -0.1), tilt}, scene::Box{{4, 4, 0.1}}, 0));
    scene::Entity entity = prototype("chain", {tilt * Vector3(0, 0, 0.05), tilt}, false,
                                     {link("base", scene::Box{{0.01, 0.01, 0.01}}, 1)});
    const scene::Box rod{{length, thick, thick}};
    for (int i = 0; i < count; ++i) {
      append(entity, link("l" + std::to_string(i), rod, 0.01),
             i == 0 ? Vector3(0, 0, thick / 2) : Vector3(length / 2, 0, thick / 2),
             Vector3(-length / 2, 0, thick / 2));
    }
    append(entity, link("load", cube, 20), Vector3(length / 2, 0, thick / 2),
           Vector3(-0.05, 0, 0.05 + thick / 2));
    world.add(entity);
    const Vector3 start = state_of(world).links.back().pose.position;
    double most = 0;
    for (int i = 0; i < 5 * hz; ++i) {
      world.step();
      most = std::max(most, fastest(world));
    }
    EXPECT_LT(most, 0.2) << hz;  // it sags by 0.5 mm
    EXPECT_LT((state_of(world).links.back().pose.position - start).norm(), 1e-3) << hz;
  }
}

/// A rope over a drum, with a load at each end.
struct Hoist {
  static constexpr double radius = 0.15, thick = 0.004,
                          height = 2;  // of the drum, the rope, the drum's axis [m]
  World world;
  double before = 0, worst_gain = 0;  // of energy [J]
  double nearest = radius;            // of the middle of a link of the rope to the drum's axis [m]

  /// @param light, heavy  [kg];  @param rod_mass  of each link of the rope [kg]
  Hoist(double hz, double light, double heavy, double rod_mass = 0.01) : world(newton(), 1 / hz) {
    constexpr int over = 12, down = 12;
    constexpr double turn = std::numbers::pi / over;
    const double length = 2 * (radius + thick / 2) * std::tan(turn / 2);
    world.add(standing({{0, -0.05, height}, about(Vector3::UnitX(), -std::numbers::pi / 2)},
                       scene::Cylinder{radius, 0.1}, 0));
    const scene::Box rod{{length, thick, thick}}, load{{0.06, 0.06, 0.06}};
    // Upwards on the left, over the drum, down on the right; along its own x.
    const double low =
        height + length / 2 - 0.03 - length * down;  // of the middle of the light load
    scene::Entity rope =
        prototype("rope", {{-radius, 0, low}, about(Vector3::UnitY(), -std::numbers::pi / 2)}, true,
                  {link("light", load, light)});
    rope.links[0].surface = {0, 0};
    for (int i = 0; i < 2 * down + over; ++i) {
      const bool bends = i >= down && i < down + over;
      append(rope, link("l" + std::to_string(i), rod, rod_mass),
             i == 0 ? Vector3(0.03, 0, thick / 2) : Vector3(length / 2, 0, thick / 2),
             Vector3(-length / 2, 0, thick / 2), bends ? turn : 0);
    }
    append(rope, link("heavy", load, heavy), Vector3(length / 2, 0, thick / 2),
           Vector3(-0.03, 0, thick / 2));
    world.add(rope);
    before = world.energy();
    for (int i = 0; i < 0.3 * hz; ++i) {
      world.step();
      worst_gain = std::max(worst_gain, world.energy() - before);
      const auto links = state_of(world).links;
      for (const auto& link : std::span(links).subspan(1)) {  // behind the drum
        nearest =
            std::min(nearest, std::hypot(link.pose.position.x(), link.pose.position.z() - height));
      }
    }
  }

  Vector3 speed_of_heavy() const { return state_of(world).links.back().velocity; }
};

// Links swing with up to 1 100 rad/s. Once they threw the loads about, and the rope went through
// the drum. Without friction energy stays, but for what the rope's corners lose where they land.
TEST(NewtonTension, OfARopeOverADrum) {
  for (const double load : long_runs::first_of({1, 10})) {
    const Vector3 expected = Hoist(2000, load, 1.5 * load).speed_of_heavy();
    for (const double hz : long_runs::substep_rates({.most = 1000, .first = 100})) {
      const Hoist hoist(hz, load, 1.5 * load);
      const double falls = earth * load * 0.3;  // as if it fell by 0.3 m [J]
      EXPECT_LT((hoist.speed_of_heavy() - expected).norm(), 0.05 * expected.norm())
          << hz << ' ' << load;
      EXPECT_LT(hoist.worst_gain, 1e-3 * falls) << hz << ' ' << load;
      EXPECT_NEAR(hoist.world.energy(), hoist.before, 0.02 * falls) << hz << ' ' << load;
    }
  }
}

// One contact of such a rope moves little, so that what it gives alone says nothing: the substep
// was taken for one that nothing holds.
TEST(NewtonTension, OfALightRopeIsCarriedByItsDrumAtAnySubstep) {
  const double expected = Hoist(1000, 1, 5, 0.002).speed_of_heavy().norm();
  for (const double hz : long_runs::first_of({4000, 8000})) {
    const Hoist hoist(hz, 1, 5, 0.002);
    EXPECT_GT(hoist.nearest, Hoist::radius - 1e-4) << hz;
    EXPECT_NEAR(hoist.speed_of_heavy().norm(), expected, 0.05 * expected) << hz;
  }
}

// A motor is to be at its target at the end of the substep, not of its first part.
TEST(NewtonTension, MotorsTakeAllPartsToTheirTargets) {
  dynamics::Link base, sled;
  base.joint = dynamics::JointType::fixed;
  sled.parent = 0;
  sled.joint = dynamics::JointType::prismatic;
  sled.mass = 1;
  sled.inertia = {1, 1, 1};
  dynamics::Tree tree({base, sled}, {});
  forward_kinematics(tree);
  velocity_kinematics(tree);
  CoordinateJoint joint;
  joint.part = 1;
  joint.mode = scene::JointMode::position;
  joint.target = 1e-3;
  dynamics::Workspace work;
  bool is_factored = false;
  EXPECT_DOUBLE_EQ(servo_of(joint, tree, work, 1e-4, 1e-2, 1e3, is_factored).target_velocity, 0.1);
  EXPECT_DOUBLE_EQ(servo_of(joint, tree, work, 1e-4, 1e-4, 1e3, is_factored).target_velocity, 10);
}

// Some 20 times as stiff as what parts can follow: that is told.
TEST(NewtonTension, BeyondWhatPartsCanFollowIsTold) {
  const Hoist hoist(10, 1000, 1500);
  EXPECT_GT(hoist.world.convergence().not_converged, 0U);
}

// From 14 links on slide and floor pressed on each other through the first link, with up to 1e10 N,
// and friction held the chain.
TEST(NewtonChain, IsDraggedOverTheFloorByASlide) {
  const double force = 3, radius = 0.005, length = 0.05, mass = 0.01, friction = 0.4, seconds = 0.5;
  for (const double hz : long_runs::some_of({100, 500})) {
    for (const int count : {10, 15, 24}) {
      World world(newton(true), 1 / hz);
      std::vector<scene::Link> links{link("base", scene::Box{{0.01, 0.01, 0.01}}, 1),
                                     link("slider", scene::Box{{0.02, 0.02, 0.02}}, 1)};
      for (int i = 0; i < count; ++i)
        links.push_back(
            link("link" + std::to_string(i), scene::Box{{2 * radius, 2 * radius, length}}, mass));
      scene::Entity chain = with_friction(prototype("chain", at(0, 0, 0.1), false, links),
                                          friction / 0.5);  // the floor has 0.5
      chain.joints.push_back(
          joint(scene::JointType::prismatic, -Vector3::UnitX(), at(-0.05, 0, 0), {}));
      const Pose lying{{0.02, 0, radius - 0.1},
                       math::Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3::UnitY()))};
      for (int i = 0; i < count; ++i) {
        scene::Joint to_next = joint(scene::JointType::spherical, Vector3::UnitZ(),
                                     i == 0 ? lying : at(0, 0, length), {});
        to_next.parent = i + 1, to_next.child = i + 2;
        chain.joints.push_back(to_next);
      }
      world.add(chain);
      world.add_motor(world.joint(0, 0), scene::JointMode::velocity, force / hz);
      world.set_target(world.joint(0, 0), 1000);
      run(world, seconds, 1 / hz);
      const double all = 1 + count * mass, moved = world.position(world.joint(0, 0));
      EXPECT_GT(moved,
                0.97 * (force - friction * count * mass * earth) / all * seconds * seconds / 2)
          << hz << ' ' << count;
      EXPECT_LT(moved, 1.03 * (force - friction * (count - 0.5) * mass * earth) / all * seconds *
                           seconds / 2)
          << hz << ' ' << count;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
