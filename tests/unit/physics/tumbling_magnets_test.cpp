// SPDX-License-Identifier: MIT
// Bodies with fixed magnets that tumble freely and fall together: kinetic
// plus magnetic energy never grows, at any substep.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../long_runs.h"
#include "magnetism/dipole.h"
#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

// Cubes of 10 mm of N42: remanence 1.3 T, 7 500 kg/m^3.
constexpr double side = 0.01, mass = 7.5e-3, remanence = 1.3;
const double moment = remanence * side * side * side / magnetism::vacuum_permeability;
/// Bond energy of two that touch, one behind the other [J].
const double bond = 2 * magnetism::magnetic_constant * moment * moment / (side * side * side);

scene::Physics floating() {
  scene::Physics physics = newton(false, 0);
  physics.magnetism = scene::Magnetism{};
  return physics;
}

scene::Entity neodymium(const Vector3& centre, const math::Quaternion& turned) {
  scene::Entity entity = loose({centre - turned * Vector3(0, 0, side / 2), turned},
                               scene::Box{{side, side, side}}, mass, 0.3);
  scene::Magnet magnet;
  magnet.anchor.link = 0;
  magnet.offset = {0, 0, side / 2};
  magnet.moment = {0, 0, moment};
  entity.devices.magnets.push_back(magnet);
  return entity;
}

/// Numbers between two bounds, the same on every machine.
class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double between(double low, double high) { return low + (high - low) * (bits_() / 4294967296.0); }
  Vector3 in_cube(double half) {
    const double x = between(-half, half), y = between(-half, half);
    return {x, y, between(-half, half)};
  }
  math::Quaternion turn() {
    const Vector3 a = in_cube(1);
    return math::Quaternion(between(-1, 1), a.x(), a.y(), a.z()).normalized();
  }

 private:
  std::mt19937 bits_;
};

/// Cubes at random in a cube, 25 mm apart or more.
void scatter(World& world, int count, unsigned seed) {
  Random random(seed);
  std::vector<Vector3> centres;
  while (static_cast<int>(centres.size()) < count) {
    const Vector3 centre = random.in_cube(count == 2 ? 0.0175 : 0.03 * std::cbrt(count));
    if (std::ranges::all_of(centres,
                            [&](const Vector3& c) { return (c - centre).norm() > 0.025; })) {
      centres.push_back(centre);
      world.add(neodymium(centre, random.turn()));
    }
  }
}

double energy(const World& world) {
  const world::State state = state_of(world);
  double total = world.energy();
  for (std::size_t i = 0; i < state.links.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Pose &a = state.links[i].pose, &b = state.links[j].pose;
      total += magnetism::dipole_energy(a.orientation * Vector3(0, 0, moment),
                                        b.orientation * Vector3(0, 0, moment),
                                        a * Vector3(0, 0, side / 2) - b * Vector3(0, 0, side / 2));
    }
  }
  return total;
}

/// By how much the energy is at most above what it was at any time before, in bonds.
double growth(World& world, double seconds, double h) {
  double least = energy(world), most = 0;
  for (int i = 0; i < seconds / h; ++i) {
    world.step();
    const double now = energy(world);
    least = std::min(least, now);
    most = std::max(most, now - least);
  }
  return most / bond;
}

class TumblingMagnets : public ::testing::TestWithParam<double> {
 protected:
  double h = 1.0 / GetParam();
};
INSTANTIATE_TEST_SUITE_P(Hertz, TumblingMagnets, ::testing::ValuesIn(long_runs::substep_rates()),
                         long_runs::name_of_rate<::testing::TestParamInfo<double>>);

TEST_P(TumblingMagnets, NoneGainsEnergy) {
  for (unsigned seed = 1; seed <= long_runs::runs(12, 4); ++seed) {
    World world(floating(), h);
    scatter(world, 2, seed);
    EXPECT_LT(growth(world, 0.5, h), 1e-3) << "seed " << seed;
  }
}

scene::Magnet along_x(int link, double moment_x) {
  scene::Magnet magnet;
  magnet.anchor.link = link;
  magnet.moment = {moment_x, 0, 0};
  return magnet;
}

scene::Entity repelling(double x) {
  scene::Entity entity =
      prototype("wall", at(x, 0, 0), false, {link("a", scene::Box{{0.01, 0.01, 0.01}}, 1)});
  entity.devices.magnets.push_back(along_x(0, -10));
  return entity;
}

// A compass swings into and out of the range of divided substeps. Velocities of whole substeps are
// those of half a substep before: without a shift between both each swing gained energy, at all
// rates.
TEST(MagnetOnARail, SwingsBetweenTwoOthersWithoutGain) {
  for (const double hz : long_runs::some_of({1000, 2000})) {
    World world(floating(), 1 / hz);
    scene::Entity rail = prototype("rail", at(0, 0, 0), false,
                                   {link("base", scene::Box{{0.001, 0.001, 0.001}}, 1),
                                    link("slider", scene::Box{{0.01, 0.01, 0.01}}, 0.1)});
    rail.joints.push_back(joint(scene::JointType::prismatic, Vector3::UnitX(), at(0.15, 0, 0), {}));
    rail.devices.magnets.push_back(along_x(1, 1));
    world.add(rail);
    world.add(repelling(0.2));
    world.add(repelling(-0.2));
    double farthest = 0;
    for (int i = 0; i < 20 * hz; ++i) {
      world.step();
      farthest = std::max(farthest, std::abs(0.15 + world.position(world.joint(0, 0))));
    }
    EXPECT_NEAR(farthest, 0.15, 1e-4) << hz;
  }
}

/// Two in line that start at rest: r'' = -c / r^4 with c = 2 * 6 K m^2 / mass, by midpoint steps.
struct Fall {
  double r;  // distance [m]
  double v = 0, t = 0;

  /// The distance after some time, not less than a side. Times must grow from call to call.
  double until(double time) {
    constexpr double step = 1e-7;
    const double c = 12 * magnetism::magnetic_constant * moment * moment / mass;
    for (; t < time && r > side; t += step) {
      const double middle = r + step / 2 * v;
      v -= step * c / std::pow(middle, 4);
      r = middle + step / 2 * v;
    }
    return std::max(r, side);
  }
};

TEST_P(TumblingMagnets, FallTogetherAsTheFormulaSays) {
  // While the pair is soft a substep takes the force at its beginning: it runs ahead by half of
  // one.
  const double start = 0.06;
  World world(floating(), h);
  world.add(neodymium({0, 0, 0}, math::Quaternion::Identity()));
  world.add(neodymium({0, 0, start}, math::Quaternion::Identity()));
  Fall now{start}, later{start};
  for (int i = 1; i * h < 0.1; ++i) {
    world.step();
    const world::State state = state_of(world);
    const double distance = state.origins[1].position.z() - state.origins[0].position.z();
    EXPECT_LT(distance, now.until(i * h) + 5e-5) << i * h;
    EXPECT_GT(distance, later.until((i + 0.6) * h) - 5e-5) << i * h;
  }
  run(world, 0.1, h);
  const world::State end = state_of(world);
  EXPECT_NEAR(end.origins[1].position.z() - end.origins[0].position.z(), side, 1e-6);
  EXPECT_LT(end.links[0].velocity.norm(), 1e-6);
  EXPECT_NEAR(end.origins[0].position.z() + end.origins[1].position.z(), start - side, 1e-6);
}

TEST(TumblingMagnets, ACloudFallsTogetherWithoutGainingEnergy) {
  const double h = 1e-3;
  World world(floating(), h);
  scatter(world, 20, 1);
  EXPECT_LT(growth(world, 0.15, h), 1e-3);
  EXPECT_LT(energy(world), -5 * bond) << "they have not fallen together";
}

TEST(TumblingMagnets, HeapsThatRollGainNoEnergy) {
  // Resolving an overlap gains energy from the magnets: a micrometre is 3e-4 of a bond.
  const double h = 1e-3;
  World world(floating(), h);
  scatter(world, long_runs::is_slow ? 10 : 30, 2);
  EXPECT_LT(growth(world, 0.1, h), 1e-3);
}

// Many distant neighbours of each body add small errors: 1e-3 to 3e-3 of a bond were gained, at any
// rate.
TEST(TumblingMagnets, FiftyOnAGridGainNoEnergyAsTheyTurnToEachOther) {
  for (const double hz : long_runs::some_of({1000, 500, 2000, 5000, 10'000})) {
    World world(floating(), 1 / hz);
    Random random(1);
    for (int i = 0; i < 50; ++i) {
      const Vector3 place = 0.03 * Vector3(i % 4, i / 4 % 4, i / 16);
      world.add(neodymium(place + random.in_cube(0.002), random.turn()));
    }
    EXPECT_LT(growth(world, 0.008, 1 / hz), 5e-4) << hz;
  }
}

TEST(TumblingMagnets, KeepTheirMomentum) {
  const double h = 1e-3;
  World world(floating(), h);
  scatter(world, 8, 3);
  run(world, 0.1, h);
  Vector3 momentum(0, 0, 0), spin(0, 0, 0);
  double fastest = 0;
  for (const world::LinkState& link : state_of(world).links) {
    const Vector3 arm = link.pose.orientation * Vector3(0, 0, side / 2);
    const Vector3 velocity = link.velocity + link.angular_velocity.cross(arm);
    momentum += mass * velocity;
    spin += mass * (link.pose.position + arm).cross(velocity) +
            mass * side * side / 6 * link.angular_velocity;
    fastest = std::max(fastest, velocity.norm());
  }
  EXPECT_LT(momentum.norm(), 1e-5 * mass * fastest);
  EXPECT_LT(spin.norm(), 1e-4 * mass * fastest * 0.06);
}

TEST(TumblingMagnets, ChangeNoBitOfWhatIsFarAway) {
  const double h = 1e-3;
  Vector3 alone, beside;
  for (const bool magnets : {false, true}) {
    scene::Physics physics = floating();
    physics.magnetism->max_distance = 1;
    World world(physics, h);
    world.add(standing(at(50, 0, 0), scene::Box{{1, 1, 0.1}}));
    scene::Entity box = loose(at(50, 0, 0.1), cube, 0.5);
    world.add(box);
    world.add(loose(at(50.05, 0, 0.25), scene::Sphere{0.02}, 0.5));
    if (magnets) scatter(world, 4, 2);
    run(world, 0.2, h);
    (magnets ? beside : alone) = origin(world, 2).position;
  }
  EXPECT_EQ(alone, beside);
}

TEST(TumblingMagnets, PlacedInsideEachOtherStayHarmless) {
  // 1 mm apart; the field of dipoles would give them 1000 bonds.
  World world(floating(), 1e-3);
  world.add(neodymium({0, 0, 0}, math::Quaternion::Identity()));
  world.add(neodymium({1e-3, 0, 0}, about({1, 1, 0}, 0.7)));
  double fastest = 0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    for (const auto& link : state_of(world).links)
      fastest = std::max(fastest, link.velocity.norm());
  }
  EXPECT_LT(mass * fastest * fastest, 10 * bond);
}

}  // namespace
}  // namespace ziggurat::physics
