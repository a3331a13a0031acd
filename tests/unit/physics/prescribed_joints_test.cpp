// SPDX-License-Identifier: MIT
// Free joints on what motors turn.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../long_runs.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

const scene::Box rod{{0.02, 0.02, 0.4}};

void add_joint(scene::Entity& entity, const char* id, const Vector3& axis, const Pose& parent,
               const Pose& child) {
  scene::Joint next = joint(scene::JointType::revolute, axis, parent, child);
  next.id = id;
  next.parent = entity.joints.size();
  next.child = next.parent + 1;
  entity.joints.push_back(next);
}

/// A hub that a motor turns about the vertical, with a rod on a hinge that hangs down from it.
/// @param lean  of the rod [rad]
scene::Entity rod_on_hub(double lean) {
  scene::Entity entity =
      prototype("governor", at(0, 0, 2), false,
                {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                 link("hub", scene::Box{{0.1, 0.1, 0.04}}, 1), link("rod", rod, 1)});
  add_joint(entity, "motor", Vector3::UnitZ(), at(0, 0, -0.2), at(0, 0, 0.02));
  add_joint(entity, "hinge", Vector3::UnitY(), {{0, 0, 0.02}, about(Vector3::UnitY(), M_PI - lean)},
            at(0, 0, 0));
  return entity;
}

void turn_hub(World& world, double speed, double h) {
  world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 1e3 * h);
  world.set_target(world.joint(0, 0), speed);
}

/// The rod's lean while the hub turns at `omega`, by the method of Runge and Kutta.
double expected_lean(double lean, double omega, double seconds) {
  const double length = rod.size.z(), width = rod.size.x();  // of 1 kg
  const double across = (width * width + length * length) / 12 + length * length / 4,
               along = width * width / 6;
  const auto acceleration = [&](double a) {
    return (omega * omega * (across - along) * std::cos(a) - earth * length / 2) * std::sin(a) /
           across;
  };
  double speed = 0;
  const int steps = 10000;
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const double k1 = acceleration(lean), k2 = acceleration(lean + h / 2 * speed);
    const double k3 = acceleration(lean + h / 2 * (speed + h / 2 * k1)),
                 k4 = acceleration(lean + h * (speed + h / 2 * k2));
    lean += h * speed + h * h / 6 * (k1 + k2 + k3);
    speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return lean;
}

// The motor's impulse that holds the hub's speed is no gain of the rod's: it once stood where it
// began, the more the shorter the substep.
TEST(NewtonDriven, ARodOnATurningHubSwingsOut) {
  const double omega = 8, lean = 0.3;
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(), 1 / hz);
    world.add(rod_on_hub(lean));
    turn_hub(world, omega, 1 / hz);
    double seconds = 0;
    for (const double until : {0.2, 0.4, 0.6, 0.8}) {
      run(world, until - seconds, 1 / hz);
      seconds = until;
      const Vector3 along = state_of(world).links[2].pose.orientation * Vector3::UnitZ();
      EXPECT_NEAR(std::acos(-along.z()), expected_lean(lean, omega, until), 1e-5)
          << hz << ' ' << until;
    }
  }
}

// Two rods on hinges that are not parallel, on a hub that its motor holds: the energy error of each
// substep is corrected.
TEST(NewtonDriven, RodsOnAHubThatIsHeldKeepTheirEnergy) {
  for (const double hz : long_runs::substep_rates()) {
    World world(newton(), 1 / hz);
    scene::Entity entity = rod_on_hub(1.4);
    entity.links.push_back(link("rod2", rod, 1));
    add_joint(entity, "hinge2", Vector3(1, 0.3, 0).normalized(),
              {{0, 0, 0.4}, about(Vector3::UnitY(), 0.7)}, at(0, 0, 0));
    world.add(entity);
    turn_hub(world, 0, 1 / hz);
    const double start = world.energy(), swing = 2 * earth * rod.size.z();
    double worst = 0;
    for (int i = 0; i < 10 * hz; ++i) {
      world.step();
      worst = std::max(worst, std::abs(world.energy() - start));
    }
    EXPECT_LT(worst, 1e-5 * swing) << hz;
  }
}

/// An arm on a gimbal, with a disc on its end that a motor spins about it.
struct Gimbal {
  double arm = 0.1, width = 0.01, arm_mass = 0.01, fork = 0.02, fork_mass = 0.001;
  double radius = 0.04, height = 0.02, mass = 0.2;

  scene::Entity entity() const {
    scene::Entity made = prototype("gyroscope", at(0, 0, 2), false,
                                   {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                    link("fork", scene::Box{{fork, fork, fork}}, fork_mass),
                                    link("arm", scene::Box{{width, width, arm}}, arm_mass),
                                    link("disc", scene::Cylinder{radius, height}, mass)});
    add_joint(made, "yaw", Vector3::UnitZ(), at(0, 0, 0.3), at(0, 0, fork / 2));
    add_joint(made, "pitch", Vector3::UnitY(),
              {{0, 0, fork / 2}, about(Vector3::UnitY(), M_PI / 2)}, at(0, 0, 0));
    add_joint(made, "spin", Vector3::UnitZ(), at(0, 0, arm), at(0, 0, height / 2));
    return made;
  }

  /// Yaw and elevation of the arm, which begins level and at rest, with its disc at `spin` [rad].
  /// With T = (across e'^2 + around(e) y'^2 + axial (spin + y' sin e)^2) / 2, Lagrange's equations:
  /// the yaw's momentum stays 0.
  std::pair<double, double> expected(double spin, double seconds) const {
    const auto box_across = [](double m, double a, double b) { return m * (a * a + b * b) / 12; };
    const double axial = mass * radius * radius / 2, arm_axial = box_across(arm_mass, width, width);
    const double across = box_across(arm_mass, width, arm) + arm_mass * arm * arm / 4 +
                          mass * arm * arm + mass * (3 * radius * radius + height * height) / 12;
    const double torque = earth * (mass * arm + arm_mass * arm / 2),
                 fork_own = box_across(fork_mass, fork, fork);
    const auto yaw_speed = [&](double e) {
      const double s = std::sin(e), c = std::cos(e);
      return -axial * spin * s / (fork_own + across * c * c + (arm_axial + axial) * s * s);
    };
    const auto acceleration = [&](double e) {
      const double s = std::sin(e), c = std::cos(e), y = yaw_speed(e);
      return ((arm_axial - across) * s * c * y * y + axial * (spin + y * s) * y * c - torque * c) /
             across;
    };
    const int steps = 20000;
    const double h = seconds / steps;
    double e = 0, speed = 0, yaw = 0;
    for (int i = 0; i < steps; ++i) {
      const double k1 = acceleration(e), k2 = acceleration(e + h / 2 * speed);
      const double k3 = acceleration(e + h / 2 * (speed + h / 2 * k1)),
                   k4 = acceleration(e + h * (speed + h / 2 * k2));
      const double next = e + h * speed + h * h / 6 * (k1 + k2 + k3);
      yaw += h / 6 * (yaw_speed(e) + 4 * yaw_speed((e + next) / 2) + yaw_speed(next));
      e = next;
      speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return {yaw, e};
  }
};

// A gyroscope whose disc a motor spins fell over where its axis nutates by half a radian per
// substep.
TEST(NewtonDriven, AGyroscopeWithAMotorPrecessesAndNutates) {
  const Gimbal gimbal;
  for (const double spin : {100., 600.}) {
    for (const double hz : long_runs::substep_rates()) {
      SCOPED_TRACE(::testing::Message() << spin << " rad/s at " << hz);
      World world(newton(), 1 / hz);
      world.add(gimbal.entity());
      world.add_motor(world.joint(0, 2), scene::JointMode::velocity, 1e3 / hz);
      world.set_target(world.joint(0, 2), spin);
      double seconds = 0;
      for (const double until : {0.1, 0.5, 1.0}) {
        run(world, until - seconds, 1 / hz);
        seconds = until;
        const auto [yaw, elevation] = gimbal.expected(spin, until);
        const Vector3 along = state_of(world).links[2].pose.orientation * Vector3::UnitZ();
        EXPECT_NEAR(std::asin(along.z()), elevation, 1e-4);
        EXPECT_NEAR(std::remainder(std::atan2(along.y(), along.x()) - yaw, 2 * M_PI), 0, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
