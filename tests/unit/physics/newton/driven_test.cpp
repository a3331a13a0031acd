// Free joints on what motors turn, with solver="newton".

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

const scene::Box rod{{0.02, 0.02, 0.4}};

void add_joint(scene::Entity& entity, const char* id, const Vector3& axis, const Pose& parent, const Pose& child) {
  scene::Joint next = joint(scene::JointType::revolute, axis, parent, child);
  next.id = id;
  next.parent = entity.joints.size();
  next.child = next.parent + 1;
  entity.joints.push_back(next);
}

/// A hub that a motor turns about the vertical, with a rod on a hinge that hangs down from it.
/// @param lean  of the rod [rad]
scene::Entity rod_on_hub(double lean) {
  scene::Entity entity = prototype("governor", at(0, 0, 2), false,
                                   {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                    link("hub", scene::Box{{0.1, 0.1, 0.04}}, 1), link("rod", rod, 1)});
  add_joint(entity, "motor", Vector3::UnitZ(), at(0, 0, -0.2), at(0, 0, 0.02));
  add_joint(entity, "hinge", Vector3::UnitY(), {{0, 0, 0.02}, about(Vector3::UnitY(), M_PI - lean)}, at(0, 0, 0));
  return entity;
}

void turn_hub(World& world, double speed, double h) {
  world.add_motor(world.joint(0, 0), scene::JointMode::velocity, 100 * h);
  world.set_target(world.joint(0, 0), speed);
}

/// The rod's lean while the hub turns at `omega`, by the method of Runge and Kutta.
double expected_lean(double lean, double omega, double seconds) {
  const double length = rod.size.z(), width = rod.size.x();  // of 1 kg
  const double across = (width * width + length * length) / 12 + length * length / 4, along = width * width / 6;
  const auto acceleration = [&](double a) {
    return (omega * omega * (across - along) * std::cos(a) - earth * length / 2) * std::sin(a) / across;
  };
  double speed = 0;
  const int steps = 10000;
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const double k1 = acceleration(lean), k2 = acceleration(lean + h / 2 * speed);
    const double k3 = acceleration(lean + h / 2 * (speed + h / 2 * k1)), k4 = acceleration(lean + h * (speed + h / 2 * k2));
    lean += h * speed + h * h / 6 * (k1 + k2 + k3);
    speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return lean;
}

// What the motor gives to hold the hub's speed is no gain of the rod's: it once stood where it began, the more
// the shorter the substep.
TEST(NewtonDriven, ARodOnATurningHubSwingsOut) {
  const double omega = 8, lean = 0.3;
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    World world(newton(), 1 / hz);
    world.add(rod_on_hub(lean));
    turn_hub(world, omega, 1 / hz);
    double seconds = 0;
    for (const double until : {0.2, 0.4, 0.6, 0.8}) {
      run(world, until - seconds, 1 / hz);
      seconds = until;
      const Vector3 along = state_of(world).links[2].pose.orientation * Vector3::UnitZ();
      EXPECT_NEAR(std::acos(-along.z()), expected_lean(lean, omega, until), 10 / hz) << hz << ' ' << until;
    }
  }
}

// Two rods on hinges that are not parallel, on a hub that its motor holds: what the forces of the beginning of a
// substep add to their turning is taken from them.
TEST(NewtonDriven, RodsOnAHubThatIsHeldKeepTheirEnergy) {
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    World world(newton(), 1 / hz);
    scene::Entity entity = rod_on_hub(1.4);
    entity.links.push_back(link("rod2", rod, 1));
    add_joint(entity, "hinge2", Vector3(1, 0.3, 0).normalized(), {{0, 0, 0.4}, about(Vector3::UnitY(), 0.7)}, at(0, 0, 0));
    world.add(entity);
    turn_hub(world, 0, 1 / hz);
    const double start = world.energy(), swing = 2 * earth * rod.size.z();
    double worst = 0;
    for (int i = 0; i < 10 * hz; ++i) {
      world.step();
      worst = std::max(worst, std::abs(world.energy() - start));
    }
    EXPECT_LT(worst, (0.002 + 1.5 / hz) * swing) << hz;
  }
}

}  // namespace
}  // namespace ziggurat::physics
