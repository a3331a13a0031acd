// SPDX-License-Identifier: MIT
#pragma once
// The Lua scripts of a scene: finds them and checks that they compile.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::processes {

/// Lua's message `file:line: …` if the script does not compile or cannot be read; otherwise
/// nothing.
std::optional<std::string> compile_error(const std::filesystem::path& script);

/// The value of `script` among these; empty if there is none.
std::string script_of(const std::vector<std::pair<std::string, std::string>>& params);

/// Whether ziggurat-lua controls its robots: it is a Lua controller without a command.
bool runs_script(const scene::Controller& controller);

/// The file with the params of an entity that has a controller.
std::string file_of_params(const scene::Scene& scene, const scene::Entity& entity);

/// The scripts that the controllers, entities and directors of a scene name, as absolute paths;
/// those that are not found are left out.
std::vector<std::filesystem::path> scripts_of(const scene::Scene& scene,
                                              const std::filesystem::path& scene_file);

/// The path of the script that an entity's Lua controller runs; empty if it names none.
std::string script_path(const scene::Scene& scene, const scene::Entity& entity,
                        const std::filesystem::path& scene_file);

/// The path of the script that a director runs; empty if it names none, or it is not found.
std::string script_path(const scene::Scene& scene, const scene::Director& director,
                        const std::filesystem::path& scene_file);

/// A fault for each script that would run and is missing or does not compile, with the line
/// of its <params>; a notice for each that names none; a warning where a function is missing that
/// each robot needs.
std::vector<scene::Problem> check_scripts(const scene::Scene& scene,
                                          const std::filesystem::path& scene_file);

}  // namespace ziggurat::processes
