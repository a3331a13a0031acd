// SPDX-License-Identifier: MIT
// A hundred small bodies fall between four walls and come to rest.

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "runs.h"

namespace ziggurat::simulation {
namespace {

using namespace testing;

/// Figures of one run of the drop scene.
struct Outcome {
  int moving = 0;          ///< bodies faster than 2 mm/s over the last tick
  int outside = 0;         ///< bodies beyond the walls' outer faces
  double lowest = 0;       ///< of all bodies at all ticks [m]
  double most_gain = 0;    ///< of total energy since an earlier tick, relative to that at release
  double mean_height = 0;  ///< of the bodies' origins at the end [m]
};

Outcome drop(const scene::Scene& scene, std::uint64_t seed, int ticks) {
  Simulation run(scene, {.seed = seed});
  const auto& entities = run.layout().entities;
  Outcome outcome;
  double least_energy = 0, released = 0;
  std::vector<math::Pose> before;
  for (int tick = 0; tick <= ticks; ++tick) {
    if (tick > 0) {
      before = run.state().origins;
      run.step();
    }
    double total = 0;
    for (std::size_t i = 0; i < entities.size(); ++i) {
      if (!falls(entities[i])) continue;
      total += energy(entities[i], run.state().links[entities[i].links.begin]);
      outcome.lowest = std::min(outcome.lowest, lowest(entities[i], run.state().origins[i]));
    }
    if (tick == 0) least_energy = released = total;
    outcome.most_gain = std::max(outcome.most_gain, (total - least_energy) / released);
    least_energy = std::min(least_energy, total);
  }
  int count = 0;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (!falls(entities[i])) continue;
    const math::Vector3 at = run.state().origins[i].position;
    const double speed = (at - before[i].position).norm() / run.physical_length();
    outcome.moving += speed > 2e-3;
    outcome.outside += std::max(std::fabs(at.x()), std::fabs(at.y())) > 0.25;
    outcome.mean_height += at.z();
    ++count;
  }
  EXPECT_EQ(count, 100);
  EXPECT_EQ(run.convergence().not_converged, 0u);
  outcome.mean_height /= count;
  return outcome;
}

void expect_rest(const Outcome& outcome) {
  EXPECT_LE(outcome.moving, 5);
  EXPECT_EQ(outcome.outside, 0);
  EXPECT_GT(outcome.lowest, -5e-4);
  EXPECT_LT(outcome.most_gain, 0.01);
  EXPECT_GT(outcome.mean_height, 0.002);
  EXPECT_LT(outcome.mean_height, 0.008);
}

TEST(Drop, FreeFallIsExact) {
  for (const scene::Clock clock : {scene::Clock::nominal, scene::Clock::beta50}) {
    Simulation run(drop_scene(clock), {.seed = 1});
    const auto& entities = run.layout().entities;
    const auto start = run.state().links;
    const int substeps = 20;
    const double h = run.physical_length() / substeps;
    int checked = 0;
    const int ticks = clock == scene::Clock::nominal ? 1 : 9;
    for (int tick = 1; tick <= ticks; ++tick) {
      run.step();
      for (std::size_t i = 0; i < entities.size(); ++i) {
        if (!falls(entities[i])) continue;
        const std::size_t link = entities[i].links.begin;
        const math::Vector3 centre(0, 0, half);
        const math::Vector3 from = start[link].pose * centre;
        const math::Vector3 to = run.state().links[link].pose * centre;
        const double n = tick * substeps;
        const double z = from.z() - gravity * h * h * n * n / 2;
        // A body that rotates has touched another one, and a low one may have hit the floor.
        const bool turned = run.state().links[link].angular_velocity.norm() > 0 || z < 2 * half;
        if (turned) continue;
        EXPECT_NEAR(to.z(), z, 1e-9) << entities[i].id << " at tick " << tick;
        EXPECT_NEAR(to.x(), from.x(), 1e-9) << entities[i].id;
        ++checked;
      }
    }
    EXPECT_GT(checked, clock == scene::Clock::nominal ? 5 : 500);
  }
}

class Seeds : public ::testing::TestWithParam<std::tuple<unsigned, std::uint64_t>> {};

TEST_P(Seeds, ComeToRestOnTheFloorInsideTheWalls) {
  const auto [iterations, seed] = GetParam();
  scene::Scene scene = drop_scene();
  scene.physics.iterations = iterations;
  expect_rest(drop(scene, seed, 75));
}

INSTANTIATE_TEST_SUITE_P(Drop, Seeds,
                         ::testing::Values(std::tuple{20u, 1u}, std::tuple{20u, 2u},
                                           std::tuple{20u, 3u}, std::tuple{10u, 1u},
                                           std::tuple{40u, 1u}));

TEST(Drop, ComesToRestInAnyOrderOfDeclaration) {
  scene::Scene scene = drop_scene();
  std::swap(scene.distributions[0], scene.distributions[1]);
  std::reverse(scene.entities.begin(), scene.entities.end());
  expect_rest(drop(scene, 1, 75));
}

TEST(Drop, ConvergesInEveryIsland) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Simulation run(drop_scene(), {.seed = seed});
    for (int tick = 0; tick < 20; ++tick) run.step();
    EXPECT_GT(run.convergence().islands, 1000u);
    EXPECT_EQ(run.convergence().not_converged, 0u) << "seed " << seed;
  }
}

TEST(Drop, IsTheSameAfterAnotherRunInTheSameProcess) {
  const auto hashes = [](const scene::Scene& scene, std::uint64_t seed) {
    Simulation run(scene, {.seed = seed});
    std::vector<std::uint64_t> all;
    for (int tick = 0; tick < 15; ++tick) {
      run.step();
      all.push_back(run.hash());
    }
    return all;
  };
  const auto first = hashes(drop_scene(), 1);
  hashes(vehicle_scene(), 1);
  EXPECT_EQ(hashes(drop_scene(), 1), first);
  EXPECT_NE(hashes(drop_scene(), 2), first);
}

}  // namespace
}  // namespace ziggurat::simulation
