#include "processes/scripts.h"

#include <fmt/format.h>

#include <lua.hpp>
#include <memory>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

// One use of a script, for messages about it.
struct Use {
  const std::vector<std::pair<std::string, std::string>>* params;
  scene::Location where;
};

bool has_own_script(const scene::Scene& scene, const scene::Entity& entity) {
  return entity.controller && entity.overrides_params &&
         runs_script(scene.controllers[*entity.controller]);
}

std::vector<Use> uses(const scene::Scene& scene) {
  std::vector<Use> result;
  for (const auto& controller : scene.controllers) {
    if (runs_script(controller)) result.push_back({&controller.params, controller.params_where});
  }
  const auto add = [&](const scene::Entity& entity) {
    if (has_own_script(scene, entity)) result.push_back({&entity.params, entity.params_where});
  };
  for (const auto& entity : scene.entities) add(entity);
  for (const auto& distribution : scene.distributions) add(distribution.entity);
  return result;
}

std::optional<std::string> fault(const std::string& script, const fs::path& naming_file,
                                 const fs::path& scene_file) {
  const auto path = find_script(script, naming_file, scene_file);
  if (!path) {
    return fmt::format(
        "script '{}' is not found; put it in the working directory, in the folder of this file or "
        "of the scene file, or in a folder above that",
        script);
  }
  if (auto error = compile_error(*path)) return "script does not compile: " + *error;
  return std::nullopt;
}

void check(const scene::Scene& scene, const Use& use, const fs::path& scene_file,
           std::vector<scene::Problem>& problems) {
  using Severity = scene::Problem::Severity;
  const auto file = scene::file_of(scene, use.where);
  const auto script = script_of(*use.params);
  if (script.empty()) {
    problems.push_back({Severity::notice, file, use.where,
                        "<params> names no script: the robots of this controller do nothing"});
  } else if (auto text = fault(script, file, scene_file)) {
    problems.push_back({Severity::fault, file, use.where, *text});
  }
}

}  // namespace

std::optional<fs::path> find_script(const std::string& script, const fs::path& naming_file,
                                    const fs::path& scene_file) {
  std::error_code error;
  const auto there = [&](const fs::path& path) { return fs::is_regular_file(path, error); };
  const fs::path relative(script);
  if (there(relative)) return fs::absolute(relative).lexically_normal();
  if (relative.is_absolute()) return std::nullopt;
  const auto beside = fs::absolute(naming_file).parent_path() / relative;
  if (there(beside)) return beside.lexically_normal();
  for (auto folder = fs::absolute(scene_file).lexically_normal().parent_path();;
       folder = folder.parent_path()) {
    if (there(folder / relative)) return (folder / relative).lexically_normal();
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

std::optional<std::string> compile_error(const fs::path& script) {
  const std::unique_ptr<lua_State, decltype(&lua_close)> lua(luaL_newstate(), lua_close);
  if (luaL_loadfilex(lua.get(), script.c_str(), "t") == LUA_OK) return std::nullopt;
  return lua_tostring(lua.get(), -1);
}

std::string script_of(const std::vector<std::pair<std::string, std::string>>& params) {
  for (const auto& [name, value] : params) {
    if (name == "script") return value;
  }
  return {};
}

bool runs_script(const scene::Controller& controller) {
  return controller.lua && controller.command.empty();
}

std::string file_of_params(const scene::Scene& scene, const scene::Entity& entity) {
  return scene::file_of(scene, entity.overrides_params
                                   ? entity.params_where
                                   : scene.controllers[*entity.controller].params_where);
}

std::vector<scene::Problem> check_scripts(const scene::Scene& scene, const fs::path& scene_file) {
  std::vector<scene::Problem> problems;
  for (const Use& use : uses(scene)) check(scene, use, scene_file, problems);
  return problems;
}

std::vector<fs::path> scripts_of(const scene::Scene& scene, const fs::path& scene_file) {
  std::vector<fs::path> scripts;
  for (const Use& use : uses(scene)) {
    const auto script = script_of(*use.params);
    if (script.empty()) continue;
    if (auto found = find_script(script, scene::file_of(scene, use.where), scene_file)) {
      scripts.push_back(std::move(*found));
    }
  }
  return scripts;
}

std::string script_path(const scene::Scene& scene, const scene::Entity& entity,
                        const fs::path& scene_file) {
  const scene::Controller& controller = scene.controllers[*entity.controller];
  const auto script = script_of(entity.overrides_params ? entity.params : controller.params);
  if (!controller.lua || script.empty()) return {};
  const auto found = find_script(script, file_of_params(scene, entity), scene_file);
  return found ? found->string() : std::string();
}

}  // namespace ziggurat::processes
