// SPDX-License-Identifier: MIT
// Mechanisms without motors that tumble on the floor, much faster than substeps can show: their
// energy never grows, whatever they hit.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "../../long_runs.h"
#include "touching.h"

namespace ziggurat::dynamics {
namespace {

using testing::g;
using testing::Touching;

struct Random {
  std::mt19937 bits;
  double operator()(double least, double most) {
    return least + (most - least) * static_cast<double>(bits()) / 4294967296.0;
  }
  Vector3 vector(double most) {
    Vector3 out;
    for (double& each : out) each = (*this)(-most, most);
    return out;
  }
};

/// A heavy root without collider that carries light links one after the other; the last touches.
Tree whip(int count, JointType joint, Random& random) {
  std::vector<Link> links{testing::box_link({0.1, 0.15, 0.3}, 8)};
  for (int i = 0; i < count; ++i) {
    const Link link = testing::box_link({0.05, 0.1, 0.25}, i % 2 == 0 ? 0.3 : 2);
    const Vector3 axis = random.vector(1).normalized();
    const Vector3 in_parent = random.vector(0.15), in_child = random.vector(0.15);
    links.push_back(testing::hung(link, i, joint, axis, in_parent, in_child));
  }
  return Tree(links, testing::at(0, 0, 0.8));
}

void tumble(double hz, JointType joint, int count, unsigned seed) {
  Random random{std::mt19937(seed)};
  Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ(), 0.5});
  world.add(whip(count, joint, random), Vector3(0.025, 0.05, 0.125), 1);
  Tree& tree = world.tree(0);
  for (double& speed : tree.v) speed = random(-3, 3);
  velocity_kinematics(tree);
  const double before = testing::energy(tree);
  double least = before;
  for (int i = 0; i < 2 * hz; ++i) {
    world.step(1 / hz);
    const double now = testing::energy(tree);
    ASSERT_LE(now - least, 0.03 * before) << hz << " " << seed << " " << i;
    least = std::min(least, now);
  }
}

/// Linear momentum along x and y [kg m/s].
Vector3 drift_of(const Tree& tree) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    sum += tree.links[i].mass * tree.velocity(static_cast<int>(i));
  }
  return {sum.x(), sum.y(), 0};
}

// A smooth floor pushes upwards only.
TEST(Tumbling, OnASmoothFloorKeepsItsDrift) {
  for (const double hz : long_runs::substep_rates()) {
    for (unsigned seed = 0; seed < long_runs::runs(4, 2); ++seed) {
      Random random{std::mt19937(seed)};
      Touching world;
      world.planes.push_back({Vector3::Zero(), Vector3::UnitZ(), 0});
      world.add(whip(2, JointType::revolute, random), Vector3(0.025, 0.05, 0.125), 0);
      Tree& tree = world.tree(0);
      for (double& speed : tree.v) speed = random(-1, 1);
      velocity_kinematics(tree);
      const Vector3 before = drift_of(tree);
      for (int i = 0; i < 2 * hz; ++i) world.step(1 / hz);
      EXPECT_LT((drift_of(tree) - before).norm(), 1e-6 * before.norm()) << hz << ' ' << seed;
    }
  }
}

TEST(Tumbling, GivesMechanismsNoEnergy) {
  for (const double hz : long_runs::some_of({100, 500})) {
    for (unsigned seed = 0; seed < long_runs::runs(30, 6); ++seed) {
      tumble(hz, JointType::revolute, 1 + seed % 3, seed);
      tumble(hz, JointType::spherical, 1 + seed % 3, seed);
    }
  }
}

// Two boxes that tumble, strike the floor and each other, and rebound.
void rebound(double hz, double restitution, unsigned seed) {
  Random random{std::mt19937(seed)};
  Touching world;
  world.restitution = restitution;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ(), 0.7});
  for (const double height : {0.4, 0.8}) {
    const int box = world.add_box({random(0.1, 0.3), random(0.1, 0.3), random(0.1, 0.3)},
                                  random(0.5, 5), testing::at(random(-0.05, 0.05), 0, height), 0.7);
    Tree& tree = world.tree(box);
    for (int k = 0; k < 3; ++k) tree.v[k] = random(-8, 8);
    velocity_kinematics(tree);
  }
  const auto energy = [&] {
    return testing::energy(world.tree(0)) + testing::energy(world.tree(1));
  };
  const double before = energy();
  double least = before;
  for (int i = 0; i < 2 * hz; ++i) {
    world.step(1 / hz);
    ASSERT_LE(energy() - least, 1e-3 * before)
        << hz << " " << restitution << " " << seed << " " << i;
    least = std::min(least, energy());
  }
}

TEST(Tumbling, ReboundsGiveBoxesNoEnergy) {
  for (const double hz : long_runs::some_of({100, 500})) {
    for (unsigned seed = 0; seed < long_runs::runs(20, 5); ++seed) {
      rebound(hz, 0.7, seed);
      rebound(hz, 1, seed);
    }
  }
}

}  // namespace
}  // namespace ziggurat::dynamics
