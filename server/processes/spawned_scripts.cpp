// SPDX-License-Identifier: MIT
#include "processes/spawned_scripts.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "processes/places.h"
#include "processes/scripts.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

/// The script in allowed places, canonical.
std::optional<fs::path> allowed_script(const std::string& script, const fs::path& scene_file,
                                       const AllowedFiles& allowed) {
  std::vector<fs::path> candidates;
  if (const auto found = find_file(script, scene_file, scene_file)) candidates.push_back(*found);
  for (const fs::path& folder : allowed.folders) candidates.push_back(folder / script);
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    const fs::path file = fs::canonical(candidate, error);
    if (error || !fs::is_regular_file(file, error)) continue;
    const bool is_named = std::ranges::find(allowed.scripts, file) != allowed.scripts.end();
    if (is_named || is_below(allowed.folders, file)) return file;
  }
  return std::nullopt;
}

void add_once(std::vector<fs::path>& folders, const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::canonical(file, error).parent_path();
  if (error || std::ranges::find(folders, folder) != folders.end()) return;
  folders.push_back(folder);
}

}  // namespace

AllowedFiles allowed_files(const scene::Scene& scene, const fs::path& scene_file,
                           const std::vector<std::string>& folders) {
  AllowedFiles allowed;
  for (const fs::path& script : scripts_of(scene, scene_file)) {
    std::error_code error;
    const fs::path file = fs::canonical(script, error);
    if (!error) allowed.scripts.push_back(file);
  }
  for (const std::string& folder : folders) {
    std::error_code error;
    const fs::path found = fs::canonical(folder, error);
    if (error || !fs::is_directory(found, error)) {
      throw std::runtime_error(fmt::format(
          "--allow-spawned-scripts is '{}', which is no folder; write the path of one", folder));
    }
    allowed.folders.push_back(found);
  }
  return allowed;
}

bool is_below(const std::vector<fs::path>& folders, const fs::path& file) {
  std::error_code error;
  const fs::path path = fs::canonical(file, error);
  if (error) return false;
  return std::ranges::any_of(folders, [&](const fs::path& folder) {
    return std::ranges::mismatch(folder, path).in1 == folder.end();
  });
}

SpawnedScript spawned_script(const scene::Scene& scene, const scene::Entity& entity,
                             const fs::path& scene_file, const AllowedFiles& allowed) {
  if (!entity.controller || !scene.controllers[*entity.controller].lua) return {};
  if (!entity.overrides_params) return {script_path(scene, entity, scene_file), {}, {}};
  const std::string script = script_of(entity.params);
  if (script.empty()) return {};
  const auto path = allowed_script(script, scene_file, allowed);
  if (!path) {
    return {{},
            fmt::format("script '{}' is neither a script that the scene names nor below a folder "
                        "that the server allows; write one of the scene's scripts, or start the "
                        "server with --allow-spawned-scripts DIR",
                        script),
            {}};
  }
  if (const auto unreadable = scene::fault_of_file(*path)) {
    return {{},
            fmt::format("script '{}' cannot be read; the server's output has the reason", script),
            fmt::format("a spawned robot's script '{}' {}", path->string(), *unreadable)};
  }
  if (auto error = compile_error(*path)) {
    return {{},
            fmt::format("script '{}' does not compile; the server's output has the reason", script),
            "a spawned robot's script does not compile: " + *error};
  }
  return {path->string(), {}, {}};
}

std::vector<fs::path> folders_of(const scene::Scene& scene, const fs::path& scene_file) {
  std::vector<fs::path> folders;
  add_once(folders, scene_file);
  for (const std::string& file : scene.files) add_once(folders, file);
  for (const fs::path& script : scripts_of(scene, scene_file)) add_once(folders, script);
  return folders;
}

}  // namespace ziggurat::processes
