// SPDX-License-Identifier: MIT
#pragma once
// Which files a robot may use that a supervisor spawns: a supervisor must not run other code of
// this machine, nor learn what its files contain.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace ziggurat::processes {

struct AllowedFiles {
  std::vector<std::filesystem::path> scripts;  ///< of the scene; canonical
  std::vector<std::filesystem::path> folders;  ///< with everything below them; canonical
};

/// The scripts that a scene names, and the folders of --allow-spawned-scripts.
/// @throws std::runtime_error if one of these is no folder
AllowedFiles allowed_files(const scene::Scene& scene, const std::filesystem::path& scene_file,
                           const std::vector<std::string>& folders);

/// Whether a file, with its symbolic links resolved, is below one of the folders.
bool is_below(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& file);

/// The script of a spawned entity's Lua controller.
struct SpawnedScript {
  std::string path;                    ///< empty if it has none, or with a fault
  std::optional<std::string> fault;    ///< for the supervisor: quotes nothing of any file
  std::optional<std::string> details;  ///< of the fault, for the person who started the server
};
SpawnedScript spawned_script(const scene::Scene& scene, const scene::Entity& entity,
                             const std::filesystem::path& scene_file, const AllowedFiles& allowed);

/// The folders of the scene, of the files that it includes and of the scripts that they name;
/// canonical, without repetition.
std::vector<std::filesystem::path> folders_of(const scene::Scene& scene,
                                              const std::filesystem::path& scene_file);

}  // namespace ziggurat::processes
