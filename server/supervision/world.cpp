// SPDX-License-Identifier: MIT
#include "supervision/world.h"

#include <fstream>
#include <iterator>
#include <utility>

#include "math/hash.h"

namespace ziggurat::supervision {

World::World(std::string path_given, scene::OpenScene opened, std::uint64_t seed_given,
             const simulation::TellStep& tell, const std::string& hash)
    : path(std::move(path_given)),
      scene(std::move(opened.scene)),
      additions(std::move(opened.additions)),
      scene_hash(hash.empty() ? supervision::scene_hash(scene) : hash),
      seed(seed_given),
      simulation(scene, {seed, tell}) {}

void World::reset(std::uint64_t new_seed, const std::function<void()>& tell) {
  const auto tell_step = [&](simulation::Step, std::size_t, std::size_t) { tell(); };
  simulation.reset(scene, {new_seed, tell ? simulation::TellStep(tell_step) : nullptr});
  seed = new_seed;
}

void World::restore(const simulation::Snapshot& snapshot) {
  simulation.restore(scene, snapshot);
  seed = snapshot.seed;
}

void World::branch(const simulation::Snapshot& snapshot, std::uint64_t new_seed) {
  simulation.restore(scene, snapshot, new_seed);
  seed = new_seed;
}

wire::SolverStatus solver_status(const simulation::Simulation& simulation) {
  const auto convergence = simulation.convergence();
  return {convergence.islands, convergence.not_converged, convergence.worst};
}

std::string scene_hash(const scene::Scene& scene) {
  math::Hash hash;
  for (const std::string& name : scene.files) {
    std::ifstream file(name, std::ios::binary);
    hash.add(std::string(std::istreambuf_iterator<char>(file), {}));
  }
  if (const std::string text = to_text(scene.variation); !text.empty()) hash.add(text);
  return math::to_hex(hash.digest());
}

}  // namespace ziggurat::supervision
