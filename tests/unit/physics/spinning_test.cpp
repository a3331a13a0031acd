// SPDX-License-Identifier: MIT
// Free rotation, gyroscopes and what must not fall asleep: closed forms at
// many substeps. Bodies are set turning by a plug-in.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../long_runs.h"
#include "newton_scene.h"
#include "physics/bodies/convert.h"
#include "physics/core.h"
#include "physics/plugins.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

/// Gives a part momenta in the first substep.
class SetVelocity final : public Plugin {
 public:
  /// @param angular  [N m s];  @param linear  [N s]
  SetVelocity(std::size_t part, const Vector3& angular, const Vector3& linear)
      : part_(part), angular_(angular), linear_(linear) {}
  void before_substep(std::span<Body> bodies, double substep) override {
    bodies[0].apply_torque(part_, to_bullet(Vector3(angular_ / substep)));
    bodies[0].apply_force(part_, to_bullet(Vector3(linear_ / substep)));
    angular_.setZero();
    linear_.setZero();
  }

 private:
  std::size_t part_;
  Vector3 angular_, linear_;
};

/// One entity in a core, with plug-ins.
struct Spinning {
  double h;
  std::vector<Body> bodies;
  NewtonCore core;
  Plugins plugins;

  Spinning(const scene::Physics& physics, double substep, const scene::Entity& entity)
      : h(substep), core(physics), plugins(physics, core) {
    bodies.push_back(core.add(entity, 0));
    plugins.add(bodies.back());
  }
  ~Spinning() { core.remove(bodies[0]); }
  void twist(std::size_t part, const Vector3& angular, const Vector3& linear = {0, 0, 0}) {
    plugins.add(std::make_unique<SetVelocity>(part, angular, linear));
  }
  void step() {
    plugins.before_substep(bodies, h);
    core.substep(bodies, h, 1, plugins.stiff());
    plugins.after_substep(bodies, h, core);
  }
  Pose pose(std::size_t part) const { return from_bullet(bodies[0].transform(part)); }
  Vector3 spin(std::size_t part) const {
    std::vector<Twist> motions;
    bodies[0].motions(motions);
    return from_bullet(motions[part].angular_velocity);
  }
};

class NewtonSpin : public ::testing::TestWithParam<double> {
 protected:
  double h = 1.0 / GetParam();
};
INSTANTIATE_TEST_SUITE_P(Hertz, NewtonSpin, ::testing::ValuesIn(long_runs::substep_rates()),
                         long_runs::name_of_rate<::testing::TestParamInfo<double>>);

// L. D. Landau, E. M. Lifshitz, Mechanics, section 37: the components of the angular velocity in
// the body are Jacobi's elliptic functions, of period 4 K(k) / rate.
void expect_free_rotation(const Vector3& omega, double h) {
  Spinning bench(newton(false, 0), h, loose(at(0, 0, 0), scene::Box{{0.1, 0.2, 0.3}}, 1));
  const Vector3 inertia = bench.bodies[0].parts[0].inertia;  // x, y, z: falling
  const double i3 = inertia.x(), i2 = inertia.y(), i1 = inertia.z();
  const Vector3 momentum = inertia.cwiseProduct(omega);
  const double energy = momentum.dot(omega) / 2, l2 = momentum.squaredNorm();
  const bool about_third = l2 > 2 * energy * i2;
  const double a = (i3 - i2) * (l2 - 2 * energy * i1), b = (i2 - i1) * (2 * energy * i3 - l2);
  const double rate = std::sqrt((about_third ? a : b) / (i1 * i2 * i3));
  const double half_period = 2 * std::comp_ellint_1(std::sqrt(about_third ? b / a : a / b)) / rate;
  bench.twist(0, momentum);
  double first = 0, last = 0, before = omega.y(), worst_energy = 0, worst_momentum = 0;
  int flips = 0;
  for (int i = 1; i * h <= long_runs::a_minute; ++i) {
    bench.step();
    const math::Quaternion turned = bench.pose(0).orientation;
    const Vector3 now = turned.conjugate() * bench.spin(0);
    const Vector3 carried = inertia.cwiseProduct(now);
    worst_energy = std::max(worst_energy, std::abs(carried.dot(now) / 2 - energy) / energy);
    worst_momentum =
        std::max(worst_momentum, (turned * carried - momentum).norm() / momentum.norm());
    if (now.y() * before < 0) {
      const double time = (i - now.y() / (now.y() - before)) * h;
      if (flips++ == 0) first = time;
      last = time;
    }
    before = now.y();
  }
  EXPECT_LT(worst_energy, 1e-3);
  EXPECT_LT(worst_momentum, 1e-3);
  if (long_runs::is_slow) return;
  ASSERT_GT(flips, 4);
  EXPECT_NEAR((last - first) / (flips - 1), half_period, 0.01 * half_period);
}

TEST_P(NewtonSpin, OfAnAsymmetricBodyKeepsEnergyAndMomentumAndFlipsOnTime) {
  expect_free_rotation({0.01, 8, 0.02}, h);
  expect_free_rotation({0.001, 10, 0}, h);  // the energy of the axis that it leaves is 1e-8 away
}

TEST_P(NewtonSpin, OfManyTurnsPerSubstepIsExact) {
  // 526 rad/s: 5.3 rad per substep at 100 Hz.
  const double speed = 526;
  for (const scene::Geometry& shape :
       {scene::Geometry(scene::Sphere{0.05}), scene::Geometry(scene::Cylinder{0.05, 0.02}),
        scene::Geometry(scene::Box{{0.1, 0.05, 0.02}})}) {
    Spinning bench(newton(false, 0), h, loose(at(0, 0, 0), shape, 1));
    bench.twist(0, {0, 0, speed * bench.bodies[0].parts[0].inertia.z()});
    const int steps = static_cast<int>(GetParam() / 2);
    for (int i = 0; i < steps; ++i) bench.step();
    EXPECT_NEAR(bench.spin(0).z(), speed, 1e-9 * speed);
    const math::Quaternion expected =
        about({0, 0, 1}, std::remainder(speed * steps * h, 2 * EIGEN_PI));
    EXPECT_LT(bench.pose(0).orientation.angularDistance(expected), 1e-3);
  }
}

/// A disc on a massless rod that turns freely about a point, 1 rad off the vertical, in steady
/// precession. @return  error of the precession after half a second, relative.
double precession_error(double h) {
  const double theta = 1, arm = 0.1, mass = 0.5, radius = 0.06, height = 0.02;
  const scene::Cylinder disc{radius, height};
  const math::Quaternion tilt = about({0, 1, 0}, theta);
  scene::Entity entity =
      prototype("top", at(0, 0, 1), false,
                {link("base", scene::Box{{0.01, 0.01, 0.01}}, 1), link("disc", disc, mass)});
  entity.joints.push_back(joint(scene::JointType::spherical, Vector3::UnitZ(), {{0, 0, 0}, tilt},
                                at(0, 0, height / 2 - arm)));
  Spinning bench(newton(false), h, entity);
  const std::size_t part = bench.bodies[0].links[1].part;
  const Vector3 inertia = bench.bodies[0].parts[part].inertia;
  const double i3 = inertia.z(), across = inertia.x() + mass * arm * arm;
  const double rate = 4, cosine = std::cos(theta);  // of the precession [rad/s]
  // m g l = rate (i3 w3 - across rate cos): H. Goldstein, Classical Mechanics, section 5.7.
  const double w3 = (mass * earth * arm / rate + across * rate * cosine) / i3;
  const Vector3 axis(std::sin(theta), 0, cosine), up(0, 0, 1);
  const Vector3 momentum = i3 * w3 * axis + across * rate * (up - cosine * axis);
  bench.twist(part, momentum);
  const int steps = static_cast<int>(std::lround(0.5 / h));
  const Vector3 pivot(0, 0, 1);
  for (int i = 0; i < steps; ++i) bench.step();
  const Vector3 now = bench.pose(part).position - pivot;
  EXPECT_NEAR(now.norm(), arm, 1e-9);
  EXPECT_NEAR(now.z() / arm, cosine, 0.02);
  return std::abs(std::atan2(now.y(), now.x()) / (rate * steps * h) - 1);
}

TEST_P(NewtonSpin, OfAGyroscopePrecessesByTheFormula) {
  EXPECT_LT(precession_error(h), GetParam() >= 1000 ? 1e-3 : 2e-2 * std::max(1.0, 100 * h));
}

TEST(NewtonSpin, OfAGyroscopeGetsBetterWithShorterSubsteps) {
  EXPECT_LT(precession_error(1e-3), precession_error(0.01) + 1e-6);
  EXPECT_LT(precession_error(5e-4), precession_error(0.02) + 1e-6);
}

/// A body that spins about its axis of symmetry lands on a smooth floor in the second substep: it
/// stops at its radius, and goes on spinning.
void expect_to_land_turning(const scene::Geometry& round, const math::Quaternion& lying,
                            double speed, double rate) {
  const double h = 0.01, radius = 0.1;
  SCOPED_TRACE(::testing::Message() << speed << " m/s " << rate << " rad/s");
  scene::Entity entity = loose({{0, 0, 0}, lying}, round, 1, 0);
  entity.pose.position.z() = radius + 1.6 * speed * h + 0.003;
  Spinning bench(newton(true, 0), h, entity);
  const Vector3 axis = lying * Vector3::UnitZ(), inertia = bench.bodies[0].parts[0].inertia;
  bench.twist(0, rate * inertia.z() * axis, {0, 0, -speed});
  for (int i = 0; i < 10; ++i) bench.step();
  EXPECT_NEAR(bench.pose(0).position.z(), radius, 2e-6);
  EXPECT_NEAR(bench.spin(0).dot(axis), rate, 1e-6 * rate);
  EXPECT_LT(bench.spin(0).cross(axis).norm(), 1e-6 * rate);
}

TEST(NewtonSpin, OfWhatIsRoundIsNotSeenByASmoothFloor) {
  const math::Quaternion side = about({0, 1, 0}, EIGEN_PI / 2);
  for (const double speed : {1., 3., 20.}) {
    for (const double rate : {5., 50., 300., 3000.}) {
      expect_to_land_turning(scene::Sphere{0.1}, side, speed, rate);
      expect_to_land_turning(scene::Cylinder{0.1, 0.2}, side, speed, rate);
      expect_to_land_turning(scene::Capsule{0.1, 0.4}, side, speed, rate);
    }
  }
}

TEST_P(NewtonSpin, AFreeBodyThatStartsSlowlyDoesNotFallAsleep) {
  World world(newton(true, 0.005), h);  // 5 mm/s^2
  world.add(loose(at(0, 0, 1), cube, 1));
  run(world, 4, h);
  EXPECT_NEAR(origin(world, 0).position.z(), 1 - 0.005 * 8, 1e-9);
}

TEST_P(NewtonSpin, ABallOnATwentiethOfADegreeRolls) {
  const double angle = 0.05 / 180 * EIGEN_PI, radius = 0.05, seconds = 4;
  const math::Quaternion tilt = about({0, 1, 0}, angle);
  World world(newton(), h);
  world.add(standing({-0.5 * (tilt * Vector3::UnitZ()), tilt}, scene::Box{{4, 2, 0.5}}, 1));
  const Vector3 start = radius * (tilt * Vector3::UnitZ()) - Vector3(0, 0, radius);
  world.add(loose({start, math::Quaternion::Identity()}, scene::Sphere{radius}, 0.1, 0.6));
  run(world, seconds, h);
  const Vector3 centre(0, 0, radius);
  const double way = (origin(world, 1) * centre - start - centre).norm();
  const double expected = 5.0 / 7 * earth * std::sin(angle) * seconds * seconds / 2;
  EXPECT_NEAR(way, expected, 0.001 * expected + 1.02 * expected * 2 * h / seconds / 2);
}

/// Largest gain of a spinning body, over its energy at the beginning, while it falls on the floor
/// and goes on there.
/// @param momentum  [N m s]
double gain_on_floor(const scene::Geometry& geometry, double mass, const Vector3& momentum,
                     double h) {
  World world(newton(true), h);
  const math::Quaternion turned = about(Vector3(1, 2, 3), 2);
  scene::Entity entity = loose({{0, 0, 0.3}, turned}, geometry, mass, 0.1);
  world.add(entity);
  const world::Push push{0, Vector3::Zero(), momentum / h};
  set_pushes(world, std::span(&push, 1));
  world.step();
  set_pushes(world, {});
  const double start = world.energy();
  double least = start, gain = 0;
  for (int i = 0; i < 2 / h; ++i) {
    world.step();
    least = std::min(least, world.energy());
    gain = std::max(gain, world.energy() - least);
  }
  return gain / start;
}

// The less it turns in a substep, the more substeps there were to gain in.
TEST(NewtonSpin, GivesNothingWhatTumblesOnTheFloor) {
  const Vector3 momentum(-0.108, -0.04, 0.116);
  for (const double hz : long_runs::substep_rates()) {
    EXPECT_LT(gain_on_floor(scene::Capsule{0.067, 0.37}, 0.315, momentum, 1 / hz), 1e-2 / hz) << hz;
    EXPECT_LT(gain_on_floor(scene::Capsule{0.02, 0.3}, 0.3, momentum, 1 / hz), 1e-2 / hz) << hz;
    EXPECT_LT(gain_on_floor(scene::Cylinder{0.027, 0.27}, 2.3, 5 * momentum, 1 / hz), 1e-2 / hz)
        << hz;
  }
}

/// A coin of 1 m that rolls in a circle and leans by 15 degrees, in steady precession about the
/// vertical.
/// @return  how far its lean is off after 4 s [rad]
double lost_lean(double h) {
  const double radius = 1, thick = 0.01, mass = 0.1, lean = 15 * EIGEN_PI / 180;
  const Vector3 up = Vector3::UnitZ(), turning = 0.7 * up;  // [rad/s]
  const Vector3 axis(std::cos(lean), 0, std::sin(lean));
  const Vector3 arm =
      axis * thick / 2 + radius * (up - axis * std::sin(lean)) / std::cos(lean);  // from the floor
  const double across = mass * (3 * radius * radius + thick * thick) / 12,
               along = mass * radius * radius / 2;
  struct Motion {
    Vector3 momentum, angular;
  };
  const auto motion_of = [&](double spin) {
    const Vector3 omega = turning + spin * axis, parallel = omega.dot(axis) * axis;
    return Motion{mass * omega.cross(arm), across * (omega - parallel) + along * parallel};
  };
  // Torques of the top and of the floor's force, which is linear in the spin:
  const auto missing = [&](double spin) {
    const Motion motion = motion_of(spin);
    const Vector3 force = turning.cross(motion.momentum) + mass * earth * up;
    return (turning.cross(motion.angular) + arm.cross(force)).y();
  };
  const Motion motion = motion_of(-missing(0) / (missing(1) - missing(0)));
  World world(newton(true), h);
  const math::Quaternion turned = about(Vector3::UnitY(), EIGEN_PI / 2 - lean);
  world.add(loose({arm - axis * thick / 2, turned}, scene::Cylinder{radius, thick}, mass, 1));
  const world::Push push{0, motion.momentum / h, motion.angular / h};
  set_pushes(world, std::span(&push, 1));
  world.step();
  set_pushes(world, {});
  run(world, 4, h);
  return std::asin((origin(world, 0).orientation * up).z()) - lean;
}

TEST(NewtonSpin, OfACoinThatRollsInACircleKeepsItsLean) {
  for (const double hz : long_runs::substep_rates({.least = 200})) {
    const double most = hz == 500 || hz == 1000 ? 0.1 : 0.3;  // [degrees]
    EXPECT_LT(std::abs(lost_lean(1 / hz)), most * EIGEN_PI / 180) << hz;
  }
}

/// Largest lean of a top on its tip on a smooth floor [rad]. With a spin about its own axis alone
/// it nutates between its initial lean and that where its precession has the lost height's energy.
/// @param spin  about its axis [rad/s];  @param axial, across  moments of inertia about its centre
///              of mass [kg m^2]
double farthest_lean(double lean, double spin, double mass, double arm, double axial,
                     double across) {
  const double momentum = axial * spin, start = std::cos(lean);
  double low = lean, high = EIGEN_PI / 2;  // p^2 (cos start - cos x) = 2 I m g l sin^2 x
  for (int i = 0; i < 60; ++i) {
    const double x = (low + high) / 2;
    const double missing = 2 * across * mass * earth * arm * std::sin(x) * std::sin(x) -
                           momentum * momentum * (start - std::cos(x));
    (missing > 0 ? low : high) = x;
  }
  return low;
}

/// A disc that spins on a small ball, which stands on a smooth floor.
struct Top {
  double mass = 0.1, radius = 0.04, height = 0.01, tip = 0.005, arm = 0.03, lean = EIGEN_PI / 12;
  double axial = mass * radius * radius / 2, across = axial / 2 + mass * height * height / 12;
  scene::JointType type = scene::JointType::fixed;  // of the disc on the ball

  double expected(double spin) const {
    return farthest_lean(lean, spin, mass, arm, axial, across) / EIGEN_PI * 180;
  }
  /// The most that it leans within two seconds [degrees].
  double measured(double spin, double hz) const {
    World world(newton(true), 1 / hz);
    const math::Quaternion tilt = about(Vector3::UnitY(), lean);
    scene::Entity top =
        prototype("top", {Vector3(0, 0, tip) - tilt * Vector3(0, 0, tip), tilt}, true,
                  {link("tip", scene::Sphere{tip}, 1e-6),
                   link("disc", scene::Cylinder{radius, height}, mass)});
    top = with_friction(top, 0);
    top.joints.push_back(joint(type, Vector3::UnitZ(), at(0, 0, tip + arm - height / 2), {}));
    world.add(top);
    const world::Push push{1, Vector3::Zero(), hz * axial * spin * (tilt * Vector3::UnitZ())};
    set_pushes(world, std::span(&push, 1));
    world.step();
    set_pushes(world, {});
    double most = 0;
    for (int i = 1; i < 2 * hz; ++i) {
      world.step();
      const Vector3 axis = origin(world, 0).orientation * Vector3::UnitZ();
      most = std::max(most, double(std::acos(axis.z()) / EIGEN_PI * 180));
    }
    return most;
  }
};

// At coarse substeps its axis turns by more than a radian in each: it leaned over by up to 73
// degrees.
TEST(NewtonSpin, OfATopOnItsTip) {
  const Top top;
  for (const double spin : long_runs::some_of({100, 50, 400})) {
    for (const double hz : long_runs::substep_rates({.most = 1000})) {
      EXPECT_NEAR(top.measured(spin, hz), top.expected(spin), 1.5) << spin << ' ' << hz;
    }
  }
}

// The same where the disc turns on a joint: it fell over.
TEST(NewtonSpin, OfARotorThatStandsOnATip) {
  Top top;
  top.type = scene::JointType::revolute;
  for (const double spin : long_runs::some_of({100, 50, 400})) {
    for (const double hz : long_runs::substep_rates({.most = 1000})) {
      EXPECT_NEAR(top.measured(spin, hz), top.expected(spin), 0.5) << spin << ' ' << hz;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
