// SPDX-License-Identifier: MIT
#include "rerun/embedded_scripts.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "processes/scripts.h"
#include "recording/replay/recording_file.h"

namespace ziggurat::rerun {
namespace {

namespace fs = std::filesystem;

/// Path that an embedded file is written to: `..` and roots are names like any other.
fs::path place(const std::string& folder, const std::string& name) {
  fs::path path = folder;
  for (const fs::path& part : fs::path(name).lexically_normal()) {
    if (part == "/" || part.empty() || part == ".") continue;
    path /= part == ".." ? fs::path("_up_") : part;
  }
  return path;
}

/// A script as the scene names it.
struct Named {
  std::string name, owner;  ///< the owner: a robot or a director
  std::string controller;   ///< that a command may be given for
};

/// A path without its root and the `..` that it begins with.
fs::path stripped(const fs::path& path) {
  fs::path rest;
  for (const fs::path& part : path.lexically_normal().relative_path()) {
    if (part != "..") rest /= part;
  }
  return rest;
}

bool ends_with(const fs::path& path, const fs::path& end) {
  return path == end || path.string().ends_with("/" + end.string());
}

/// The embedded file that this script can only be. Embedded names are as seen from the folder where
/// the run was started: of a script that a scene names from the root such a name is the end, less
/// any `..`; it ends itself as one that a scene names otherwise.
std::optional<std::string> only_file_of(const fs::path& script,
                                        const replay::EmbeddedFiles& files) {
  const fs::path path = stripped(script);
  std::optional<std::string> found;
  for (const auto& [name, bytes] : files.all()) {
    const fs::path embedded = stripped(name);
    if (script.is_absolute() ? !ends_with(path, embedded) : !ends_with(embedded, path)) continue;
    if (found) return std::nullopt;
    found = name;
  }
  return found;
}

/// Path of the written script. @throws replay::RecordingError if it is not embedded
std::string embedded_script(const std::string& folder, const replay::EmbeddedFiles& files,
                            const scene::Scene& scene, const std::string& scene_path,
                            const Named& script) {
  std::vector<fs::path> folders;  // where a run looks for scripts, too
  for (const std::string& file : scene.files) folders.push_back(fs::path(file).parent_path());
  for (fs::path up = fs::path(scene_path).parent_path(); !up.empty(); up = up.parent_path()) {
    folders.push_back(up);
    if (up == up.parent_path()) break;
  }
  folders.emplace_back();
  for (const fs::path& each : folders) {
    const fs::path path = each / script.name;
    if (files.find(path)) return place(folder, path.string()).string();
  }
  if (const auto path = only_file_of(script.name, files)) return place(folder, *path).string();
  throw replay::RecordingError(
      fmt::format("the script '{}' of '{}' is not in the recording, or cannot be told from others; "
                  "write --controller {}=CMD",
                  script.name, script.owner, script.controller));
}

}  // namespace

void write_below(const std::string& folder, const replay::EmbeddedFiles& files) {
  fs::create_directories(folder);
  for (const auto& [name, bytes] : files.all()) {
    const fs::path path = place(folder, name);
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw std::runtime_error(fmt::format("{} cannot be written", path.string()));
  }
}

std::string script_below(const std::string& folder, const replay::EmbeddedFiles& files,
                         const scene::Scene& scene, const std::string& scene_path,
                         const world::RobotLayout& robot) {
  const scene::Controller& controller = scene.controllers[robot.controller];
  if (!processes::runs_script(controller)) return {};
  const std::string name = processes::script_of(robot.params);
  if (name.empty()) return {};
  return embedded_script(folder, files, scene, scene_path, {name, robot.id, controller.id});
}

std::string script_below(const std::string& folder, const replay::EmbeddedFiles& files,
                         const scene::Scene& scene, const std::string& scene_path,
                         const scene::Director& director) {
  if (director.script.empty()) return {};
  return embedded_script(folder, files, scene, scene_path,
                         {director.script, director.id, director.id});
}

}  // namespace ziggurat::rerun
