// SPDX-License-Identifier: MIT
#pragma once
// The world of a run: what it was made from and what it has become.

#include <cstdint>
#include <functional>
#include <string>

#include "scene/additions.h"
#include "scene/scene.h"
#include "simulation/simulation.h"
#include "wire/request.h"

namespace ziggurat::supervision {

struct World {
  /// @param tell  while entities are distributed; may be empty
  /// @param hash  of the scene's files; empty: they are read for it
  /// @throws scene::SceneError if an entity cannot be placed or built
  World(std::string path, scene::OpenScene opened, std::uint64_t seed,
        const simulation::TellStep& tell = {}, const std::string& hash = {});

  /// Builds the world again, with this seed. @throws scene::SceneError; then nothing changes
  /// @param tell  called now and then
  void reset(std::uint64_t new_seed, const std::function<void()>& tell = {});

  /// Puts the world back. @throws std::runtime_error; then nothing changes
  void restore(const simulation::Snapshot& snapshot);

  /// Puts this world into the state of a world of a scene with other values, with this seed from
  /// then on.
  /// @throws simulation::SnapshotError; then nothing changes
  void branch(const simulation::Snapshot& snapshot, std::uint64_t new_seed);

  const std::string path;  ///< of the scene file
  const scene::Scene scene;
  const scene::Additions additions;  ///< reads elements that are added to the scene
  const std::string scene_hash;      ///< of the scene's files: 16 hexadecimal digits
  std::uint64_t seed;
  simulation::Simulation simulation;
};

/// Since the start or the last reset.
wire::SolverStatus solver_status(const simulation::Simulation& simulation);

/// The hash of the scene's files: 16 hexadecimal digits.
std::string scene_hash(const scene::Scene& scene);

}  // namespace ziggurat::supervision
