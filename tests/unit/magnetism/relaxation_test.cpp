// SPDX-License-Identifier: MIT
#include "magnetism/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "magnetism/exact_field.h"
#include "magnetism/field.h"
#include "magnetism/stiffness.h"

namespace ziggurat::magnetism {
namespace {

constexpr double sphere_moment = 65 * 2.6552e-3;  // [A m^2]

TEST(Turned, IsTheExactSolutionOfTheOverdampedEquation) {
  const Vector3 direction(std::sin(2.5), 0, std::cos(2.5));
  const Vector3 field(0, 0, 0.01);
  const double rate = 1000;
  // Integrated in small steps: dtheta/dt = -rate B sin(theta).
  double theta = 2.5;
  for (int k = 0; k < 100000; ++k) {
    const double middle = theta - 0.5 * 2e-6 * rate * 0.01 * std::sin(theta);
    theta -= 2e-6 * rate * 0.01 * std::sin(middle);
  }
  const Vector3 next = turned(direction, field, rate, 0.2);
  EXPECT_NEAR(std::atan2(next.x(), next.z()), theta, 1e-6);
  EXPECT_NEAR(next.norm(), 1, 1e-15);
  // Two half steps equal one whole step.
  const Vector3 halves = turned(turned(direction, field, rate, 0.1), field, rate, 0.1);
  EXPECT_LE((halves - next).norm(), 1e-14);
}

TEST(Turned, EndsAlongTheFieldAndLeavesTheUnstableEquilibrium) {
  const Vector3 field(0.01, 0.02, -0.02);
  EXPECT_LE((turned({0, 0, 1}, field, 1e6, 1e6) - field.normalized()).norm(), 1e-15);
  const Vector3 against = -field.normalized();
  const Vector3 next = turned(against, field, 1000, 5);
  EXPECT_GT(next.dot(field.normalized()), 0.9);
  EXPECT_EQ(turned(against, Vector3::Zero(), 1000, 5), against);
  EXPECT_EQ(turned(field.normalized(), field, 1000, 5), field.normalized());
}

TEST(Tilted, IsAMilliradianAndDifferentForEveryIndex) {
  const Vector3 up = Vector3::UnitZ();
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(std::acos(tilted(up, i).dot(up)), 1e-3, 1e-8);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((tilted(up, i) - tilted(up, j)).norm(), 1e-9);
  }
}

/// Blocks of 55 mm with eight free spheres 22.5 mm from the centre along each axis.
struct Blocks {
  std::vector<Magnet> magnets;
  std::vector<Pose> poses;
  std::vector<double> currents;
  std::vector<Wrench> wrenches;
};

Blocks blocks(const std::vector<Vector3>& centres) {
  Blocks result;
  for (std::size_t b = 0; b < centres.size(); ++b) {
    result.poses.push_back({centres[b], Quaternion::Identity()});
    for (int k = 0; k < 8; ++k) {
      Magnet magnet;
      magnet.body = static_cast<std::uint32_t>(b);
      magnet.position = {k & 1 ? 0.0225 : -0.0225, k & 2 ? 0.0225 : -0.0225,
                         k & 4 ? 0.0225 : -0.0225};
      magnet.passive_moment = {0, 0, sphere_moment};
      magnet.shape = Sphere{0.003};
      magnet.freely_turning = true;
      result.magnets.push_back(magnet);
    }
  }
  result.currents.assign(result.magnets.size(), 0);
  result.wrenches.resize(centres.size());
  return result;
}

double energy(const Field& field, const Blocks& scene) {
  double sum = 0;
  const auto position = [&](std::size_t i) {
    return scene.poses[scene.magnets[i].body] * scene.magnets[i].position;
  };
  for (std::size_t i = 0; i < scene.magnets.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.magnets.size(); ++j) {
      sum += dipole_energy(field.moment(i), field.moment(j), position(i) - position(j));
    }
  }
  return sum;
}

// All magnets up at a 10 mm distance: an exact symmetry in which, with a 40 mm cut-off, every
// magnet has a field exactly opposite to it. The tilt breaks the symmetry, and the blocks attract.
TEST(FreeMagnets, LeaveExactSymmetriesAndAttract) {
  Blocks scene = blocks({{0, 0, 0}, {0.055, 0, 0}});
  Options options;
  options.max_distance = 0.04;
  Field field(scene.magnets, 2, options);
  for (int step = 0; step < 20; ++step) {
    field.evaluate(0.01, scene.poses, scene.currents, scene.wrenches);
  }
  EXPECT_GT(scene.wrenches[0].force.x(), 5);  // four pairs of 1.79 N
  EXPECT_LT(scene.wrenches[0].force.x(), 7.3);
  EXPECT_NEAR(scene.wrenches[0].force.x(), -scene.wrenches[1].force.x(), 1e-12);
}

TEST(FreeMagnets, TurningNeverRaisesTheEnergy) {
  Blocks scene = blocks({{0, 0, 0}, {0.056, 0.003, 0}, {0.01, 0.057, 0.002}});
  Field field(scene.magnets, 3, {});
  field.evaluate(0, scene.poses, scene.currents, scene.wrenches);
  double last = energy(field, scene);
  for (int step = 0; step < 200; ++step) {
    field.evaluate(1e-4, scene.poses, scene.currents, scene.wrenches);
    const double now = energy(field, scene);
    EXPECT_LE(now, last + 1e-14);
    last = now;
  }
  EXPECT_LT(last, -0.03);
}

// A freely turning magnet transmits no torque, but r x F of two magnets of one block does.
TEST(FreeMagnets, PairsWithinABlockKeepTheirLeverArm) {
  std::vector<Magnet> magnets(2);
  magnets[0] = {.position = {0.02, 0, 0}, .passive_moment = {0, 0, 1}, .freely_turning = true};
  magnets[1] = {.position = {-0.02, 0, 0}, .passive_moment = {1, 0, 0}};
  Field field(magnets, 1, {});
  const std::vector<Pose> poses(1);
  const std::vector<double> currents(2, 0);
  std::vector<Wrench> wrench(1);
  field.evaluate(0, poses, currents, wrench);
  const auto pair = dipole_pair(field.moment(0), {1, 0, 0}, {0.04, 0, 0});
  const Vector3 expected = Vector3(0.04, 0, 0).cross(pair.force_on_first) + pair.torque_on_second;
  EXPECT_LE((wrench[0].torque - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LE((wrench[0].torque + pair.torque_on_first).norm(), 1e-12 * expected.norm());
  EXPECT_LE(wrench[0].force.norm(), 1e-15);
}

TEST(FreeMagnets, CanBeReadResetAndRestored) {
  Blocks scene = blocks({{0, 0, 0}, {0.055, 0, 0}});
  Field field(scene.magnets, 2, {});
  const std::vector<Quaternion> start(field.turns().begin(), field.turns().end());
  for (int step = 0; step < 10; ++step) {
    field.evaluate(0.01, scene.poses, scene.currents, scene.wrenches);
  }
  const std::vector<Quaternion> later(field.turns().begin(), field.turns().end());
  for (std::size_t i = 0; i < later.size(); ++i) {
    EXPECT_LE((later[i] * scene.magnets[i].passive_moment - field.moment(i)).norm(),
              1e-12 * sphere_moment);
  }
  field.evaluate(0.01, scene.poses, scene.currents, scene.wrenches);
  const Vector3 force = scene.wrenches[0].force;
  field.reset();
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(field.turns()[i].coeffs(), start[i].coeffs());
  }
  field.set_turns(later);
  field.evaluate(0.01, scene.poses, scene.currents, scene.wrenches);
  EXPECT_EQ(scene.wrenches[0].force, force);
}

TEST(FreeMagnets, TurnTowardsTheTrueFieldOfAShape) {
  std::vector<Magnet> magnets(2);
  magnets[0] = {.body = 0,
                .passive_moment = moment_of_remanence({0, 0, 1.3}, 1e-6),
                .shape = Box{{0.02, 0.01, 0.005}}};
  magnets[1] = {.body = 1, .passive_moment = {0, 0, 0.1}, .freely_turning = true};
  Options options;
  options.precision = Precision::adaptive;
  Field field(magnets, 2, options);
  const std::vector<Pose> poses = {{}, {{0.011, 0, 0.006}, Quaternion::Identity()}};
  std::vector<Wrench> wrenches(2);
  const std::vector<double> currents(2, 0);
  field.evaluate(10, poses, currents, wrenches);
  const Vector3 direction =
      box_field({0.02, 0.01, 0.005}, {0, 0, 1.3 / vacuum_permeability}, poses[1].position)
          .normalized();
  EXPECT_LE((field.moment(1).normalized() - direction).norm(), 1e-9);
}

// Two free rigid bodies, coupled by their magnets: w dt <= 0.1, ten periods.
TEST(Energy, OfTwoFreeBodiesIsConserved) {
  const double moment = 1;
  const double mass = 0.1;
  const double inertia = 1e-5;
  std::vector<Magnet> magnets(2);
  magnets[0] = {.body = 0, .passive_moment = {0, 0, moment}};
  magnets[1] = {.body = 1, .passive_moment = {0, 0, moment}};
  Field field(magnets, 2, {});
  std::vector<Pose> poses = {{{0, 0, 0}, Quaternion(Eigen::AngleAxisd(0.2, Vector3::UnitX()))},
                             {{0, 0, 0.06}, Quaternion(Eigen::AngleAxisd(0.1, Vector3::UnitY()))}};
  // The two bodies orbit each other, so that they do not collide.
  const double pull = 6e-7 / std::pow(0.06, 4);
  std::vector<Vector3> velocities = {{-std::sqrt(pull * 0.03 / mass) * 1.1, 0, 0},
                                     {std::sqrt(pull * 0.03 / mass) * 1.1, 0, 0}};
  std::vector<Vector3> spins(2, Vector3::Zero());
  const double rate = std::sqrt(2 * 2e-7 / std::pow(0.06, 3) / inertia);
  const double dt = 0.1 / rate / 2;
  std::vector<Wrench> wrenches(2);
  const std::vector<double> currents(2, 0);
  const auto total = [&] {
    double sum =
        dipole_energy(field.moment(0), field.moment(1), poses[0].position - poses[1].position);
    for (int b = 0; b < 2; ++b) {
      sum += mass / 2 * velocities[b].squaredNorm() + inertia / 2 * spins[b].squaredNorm();
    }
    return sum;
  };
  const auto kick = [&] {
    field.evaluate(0, poses, currents, wrenches);
    for (int b = 0; b < 2; ++b) {
      velocities[b] += dt / 2 / mass * wrenches[b].force;
      spins[b] += dt / 2 / inertia * wrenches[b].torque;
    }
  };
  field.evaluate(0, poses, currents, wrenches);
  const double start = total();
  const double scale = std::fabs(dipole_energy({0, 0, 1}, {0, 0, 1}, {0, 0, 0.06}));
  const int steps = static_cast<int>(10 * 2 * pi / rate / dt);
  for (int step = 0; step < steps; ++step) {
    kick();
    for (int b = 0; b < 2; ++b) {
      poses[b].position += dt * velocities[b];
      const double angle = spins[b].norm() * dt;
      if (angle > 0) {
        poses[b].orientation =
            Quaternion(Eigen::AngleAxisd(angle, spins[b].normalized())) * poses[b].orientation;
      }
    }
    kick();
    EXPECT_NEAR(total(), start, 0.01 * scale) << step;
  }
}

// The study's block: 0.110 kg, 5.95e-5 kg m^2, four pairs of 1.787 N at 10 mm: 715 N/m, 0.72 N
// m/rad, w dt = 1.14 sideways and 1.56 in twist at 10 ms.
TEST(Stiffness, OfTheBlockMatchesTheStudy) {
  const Blocks scene = blocks({{0, 0, 0}});
  const BondedBody block{Vector3::Constant(0.0275), Vector3::Zero(), 0.110,
                         Vector3::Constant(5.95e-5)};
  for (const Bond& bond : bonds(scene.magnets, 0, block)) {
    EXPECT_NEAR(bond.stiffness, 715, 5);
    EXPECT_NEAR(bond.twist, 0.72, 0.01);
    EXPECT_NEAR(0.01 * bond.lateral_rate, 1.14, 0.01);
    EXPECT_NEAR(0.01 * bond.twist_rate, 1.56, 0.01);
  }
  EXPECT_LT(0.01 * stiffest_rate(scene.magnets, 0, block), stiffest_product);
  auto strong = scene.magnets;
  for (Magnet& magnet : strong) magnet.passive_moment *= 1.1;
  EXPECT_GT(0.01 * stiffest_rate(strong, 0, block), stiffest_product);
}

// The stiffness is the slope of the sideways force itself.
TEST(Stiffness, IsTheSlopeOfTheSidewaysForce) {
  const double moment = 0.2;
  const auto fixed = dipole_pair({0, 0, moment}, {0, 0, moment}, {1e-6, 0, 0.01});
  EXPECT_NEAR(-fixed.force_on_first.x() / 1e-6, 12e-7 * moment * moment / 1e-10, 1);
}

}  // namespace
}  // namespace ziggurat::magnetism
