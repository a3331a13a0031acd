// SPDX-License-Identifier: MIT
#include "processes/scripts.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <lua.hpp>
#include <memory>
#include <string_view>

#include "processes/places.h"
#include "processes/required_scripts.h"
#include "scene/files.h"
#include "scene/names.h"
#include "text/shortened.h"

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
  const auto path = find_file(script, naming_file, scene_file);
  if (!path) {
    return fmt::format("script '{}' is not found{}", text::shortened(script),
                       looked_for(script, naming_file, scene_file));
  }
  if (const auto unreadable = scene::fault_of_file(*path)) {
    return fmt::format("script '{}' {}", text::shortened(path->string()), *unreadable);
  }
  if (auto error = compile_error(*path)) return "script does not compile: " + *error;
  return std::nullopt;
}

bool is_part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool has_word(const std::string& text, std::string_view word) {
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_part_of_name(text[at - 1]);
    if (begins && (end == text.size() || !is_part_of_name(text[end]))) return true;
  }
  return false;
}

/// A function that a robot needs, of which the script does not have the name. One that loads others
/// may have it from there.
std::optional<std::string_view> missing_function(const fs::path& script) {
  std::ifstream file(script, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  for (const std::string_view other : {"require", "dofile", "loadfile", "load", "_G", "_ENV"}) {
    if (has_word(text, other)) return std::nullopt;
  }
  for (const std::string_view name : {"init", "step"}) {
    if (!has_word(text, name)) return name;
  }
  return std::nullopt;
}

/// Warnings on what a script requires and is not there.
void check_modules(const fs::path& script, const std::string& file, const scene::Location& where,
                   std::vector<scene::Problem>& problems) {
  for (const MissingModule& each : missing_modules(script)) {
    problems.push_back({scene::Problem::Severity::warning, file, where,
                        fmt::format("{}:{}: require \"{}\" finds no such module; write it as a "
                                    "file {}.lua beside the script",
                                    each.script.string(), each.line, text::shortened(each.name),
                                    text::shortened(each.name))});
  }
}

/// A parameter that was probably meant to be the script; empty if there is none.
std::string name_like_script(const std::vector<std::pair<std::string, std::string>>& params) {
  for (const auto& [name, value] : params) {
    const std::array candidates{std::string_view("script")};
    if (name == "script") continue;  // its value is empty
    if (scene::nearest(name, candidates) || value.ends_with(".lua")) return name;
  }
  return {};
}

void check(const scene::Scene& scene, const Use& use, const fs::path& scene_file,
           std::vector<scene::Problem>& problems) {
  using Severity = scene::Problem::Severity;
  const auto file = scene::file_of(scene, use.where);
  const auto script = script_of(*use.params);
  if (script.empty()) {
    const auto slip = name_like_script(*use.params);
    problems.push_back(
        {slip.empty() ? Severity::notice : Severity::warning, file, use.where,
         "<params> names no script: the robots of this controller do nothing" +
             (slip.empty() ? slip
                           : fmt::format("; did you mean script=\"…\" by {}=\"…\"?", slip))});
  } else if (auto text = fault(script, file, scene_file)) {
    problems.push_back({Severity::fault, file, use.where, *text});
  } else if (const auto name = missing_function(*find_file(script, file, scene_file))) {
    problems.push_back({Severity::warning, file, use.where,
                        fmt::format("script '{0}' has no function {1}(), which each robot needs; "
                                    "write: function {1}() end",
                                    script, *name)});
  }
  if (const auto path = script.empty() ? std::nullopt : find_file(script, file, scene_file)) {
    check_modules(*path, file, use.where, problems);
  }
}

}  // namespace

std::optional<std::string> compile_error(const fs::path& script) {
  if (const auto fault = scene::fault_of_file(script)) {
    return fmt::format("'{}' {}", script.string(), *fault);
  }
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
  for (const scene::Director& director : scene.directors) {
    const auto file = scene::file_of(scene, director.where);
    if (director.script.empty()) continue;
    if (auto text = fault(director.script, file, scene_file)) {
      problems.push_back({scene::Problem::Severity::fault, file, director.where, *text});
    } else {
      check_modules(*find_file(director.script, file, scene_file), file, director.where, problems);
    }
  }
  return problems;
}

std::vector<fs::path> scripts_of(const scene::Scene& scene, const fs::path& scene_file) {
  std::vector<fs::path> scripts;
  for (const Use& use : uses(scene)) {
    const auto script = script_of(*use.params);
    if (script.empty()) continue;
    if (auto found = find_file(script, scene::file_of(scene, use.where), scene_file)) {
      scripts.push_back(std::move(*found));
    }
  }
  for (const scene::Director& director : scene.directors) {
    if (auto path = script_path(scene, director, scene_file); !path.empty()) {
      scripts.emplace_back(std::move(path));
    }
  }
  return scripts;
}

std::string script_path(const scene::Scene& scene, const scene::Entity& entity,
                        const fs::path& scene_file) {
  const scene::Controller& controller = scene.controllers[*entity.controller];
  const auto script = script_of(entity.overrides_params ? entity.params : controller.params);
  if (!controller.lua || script.empty()) return {};
  const auto found = find_file(script, file_of_params(scene, entity), scene_file);
  return found ? found->string() : std::string();
}

std::string script_path(const scene::Scene& scene, const scene::Director& director,
                        const fs::path& scene_file) {
  if (director.script.empty()) return {};
  const auto found = find_file(director.script, scene::file_of(scene, director.where), scene_file);
  return found ? found->string() : std::string();
}

}  // namespace ziggurat::processes
