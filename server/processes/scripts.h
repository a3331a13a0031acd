#pragma once
// Lua scripts named by a scene: where they are, and whether they can run at all.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::processes {

/// Looks in the working directory, beside the file that names the script, then in the scene file's
/// folder and its parents.
/// @returns an absolute path
std::optional<std::filesystem::path> find_script(const std::string& script,
                                                 const std::filesystem::path& naming_file,
                                                 const std::filesystem::path& scene_file);

/// Lua's own `file:line: message` if the text doesn't compile or can't be read; else nothing.
std::optional<std::string> compile_error(const std::filesystem::path& script);

/// The value of `script` among these; empty if there is none.
std::string script_of(const std::vector<std::pair<std::string, std::string>>& params);

/// Whether ziggurat-lua drives its robots: it is a Lua controller that no command replaces.
bool runs_script(const scene::Controller& controller);

/// The file that says the params of an entity with a controller.
std::string file_of_params(const scene::Scene& scene, const scene::Entity& entity);

/// A fault if the script that an entity names in <params> of its own is missing or doesn't compile.
std::vector<scene::Problem> check_script(const scene::Scene& scene, const scene::Entity& entity,
                                         const std::filesystem::path& scene_file);

/// The path of the script that an entity's Lua controller runs; empty if it names none.
std::string script_path(const scene::Scene& scene, const scene::Entity& entity,
                        const std::filesystem::path& scene_file);

/// A fault for each script that would run and is missing or doesn't compile, with the line
/// of its <params>; a notice for each that names none.
std::vector<scene::Problem> check_scripts(const scene::Scene& scene,
                                          const std::filesystem::path& scene_file);

}  // namespace ziggurat::processes
