#include "dynamics/nutation.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::dynamics {
namespace {

/// How far an axis may turn by itself within a step that is not divided, and how far in a part of one that is [rad].
constexpr double too_far = 0.2, of_a_part = 0.12;
/// Of an island that is divided: a heap need not know.
constexpr std::size_t most_trees = 8;

/// How fast the axis of a single body may turn by itself [rad/s]; 0 where it spins about a principal one.
double nutation(const Tree& tree) {
  constexpr double little = 1e-4;  // sine of the angle between spin and angular momentum
  const Vector3& inertia = tree.links[0].inertia;
  const Vector3 spin = tree.rotation[0].transpose() * tree.motion[0].angular, momentum = spin.cwiseProduct(inertia);
  if (!(spin.cross(momentum).norm() > little * spin.norm() * momentum.norm())) return 0;
  Vector3 sorted = inertia;
  std::sort(sorted.begin(), sorted.end());
  return spin.norm() * (sorted[2] - sorted[0]) / sorted[1];
}

}  // namespace

int parts_for_nutation(const Problem& problem) {
  if (problem.trees.size() > most_trees) return 1;
  double fastest = 0;
  for (const Block& block : problem.blocks) {
    for (const int place : {block.a, block.b}) {
      if (place < 0 || !problem.trees[place]->single || block.impulse[0] == 0) continue;
      fastest = std::max(fastest, nutation(*problem.trees[place]));
    }
  }
  const double most = problem.length * fastest;
  return most > too_far ? static_cast<int>(std::min(std::ceil(most / of_a_part), 1e6)) : 1;
}

}  // namespace ziggurat::dynamics
