// SPDX-License-Identifier: MIT
#pragma once
// Loads a scene for a run: reads it, applies the options, checks the scripts.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/console.h"
#include "run/options.h"
#include "scene/scene.h"
#include "simulation/simulation.h"

namespace ziggurat::run {

/// Reads the scene and prints its notices. @throws scene::SceneError with all faults found
scene::OpenScene load_scene(const std::string& path, const Options& options,
                            reports::Console& console);

/// The seed of the options, otherwise the usual one; drawn from the system if that is 0.
std::uint64_t choose_seed(const Options& options, std::uint64_t usual);

/// The tick that contains a simulated time [s].
std::uint64_t tick_at(double time, const scene::Experiment& experiment);

/// Number of ticks of the run; nothing: until it is stopped.
/// @throws text::UsageError if it is shorter than one tick
std::optional<std::uint64_t> tick_count(const Options& options, const scene::Scene& scene);

/// Per robot of the layout: the path of its Lua script; empty if it has none.
std::vector<std::string> script_paths(const scene::Scene& scene, const world::Layout& layout,
                                      const std::string& scene_path);

}  // namespace ziggurat::run
