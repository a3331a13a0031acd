#pragma once
// From a path to a scene that can run: read, overridden by the command line, scripts verified.

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

/// The seed of the command line, else of the scene; a fresh one from the system if that is 0.
std::uint64_t choose_seed(const Options& options, const scene::Scene& scene);

/// How many ticks the run has; nothing = until somebody stops it.
/// @throws UsageError if it is shorter than one tick
std::optional<std::uint64_t> tick_count(const Options& options, const scene::Scene& scene);

/// Of the scene's files: 16 hexadecimal digits.
std::string scene_hash(const scene::Scene& scene);

/// Per robot of the layout: where its Lua script is; empty for others.
std::vector<std::string> script_paths(const scene::Scene& scene, const world::Layout& layout,
                                      const std::string& scene_path);

}  // namespace ziggurat::run
