// SPDX-License-Identifier: MIT
#pragma once
// The files that the runs of a sweep read: a sweep that is continued must find them unchanged.

#include <map>
#include <string>
#include <vector>

#include "scene/problem.h"
#include "sweep/experiment.h"

namespace ziggurat::sweep {

struct SceneFiles {
  std::map<std::string, std::string> hashes;  ///< 16 hexadecimal digits, by path
  std::uint64_t seed = 0;                     ///< of the scene; 0: each run draws one
  double length = 0;  ///< of the scene, simulated [s]: the least, if axes set it; 0: without end
  std::vector<scene::Problem> warnings;  ///< each once
};

/// Reads the scene, with each value of each axis at least once, and all that it includes, its
/// meshes and Lua scripts. Programs of external controllers are not looked at.
/// @throws scene::SceneError with the faults of the scene or of an axis
SceneFiles read_scene(const Experiment& experiment);

}  // namespace ziggurat::sweep
