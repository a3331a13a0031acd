// SPDX-License-Identifier: MIT
#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "scene/draft.h"
#include "scene/names.h"
#include "text/shortened.h"

namespace ziggurat::scene {
namespace {

using namespace std::string_view_literals;
using Root = std::pair<std::string_view, std::string_view>;

/// Root elements of other formats.
constexpr std::array<Root, 4> foreign_roots{{
    {"sdf", "an SDF file"},
    {"robot", "a URDF file"},
    {"mujoco", "an MJCF file"},
    {"gazebo", "a Gazebo file"},
}};

/// Why a file without any element is no scene.
std::string no_xml(const std::string& name) {
  if (name.ends_with(".lua")) {
    return "this is a Lua script, no scene; name it in a scene, <params script=\"…\"/> of a "
           "<lua_controller>, and run that scene";
  }
  return "this is no XML; a scene is an XML file that begins with <argos-configuration>";
}

constexpr std::string_view usual_root = "argos-configuration";

bool is_nearly_usual(std::string_view name) {
  const bool is_cut = name.starts_with("argos") && name.size() > "argos"sv.size();
  return is_cut || nearest(name, {&usual_root, 1});
}

/// Reports a root that is no scene's; false then.
bool check_root(const Element& root, const pugi::xml_node& node) {
  for (const auto& [name, format] : foreign_roots) {
    if (root.name() != name || node.child("arena")) continue;
    root.fault(
        fmt::format("is the root of {}, which cannot be read; a scene begins with "
                    "<argos-configuration>, and its robots are written as <prototype>",
                    format));
    return false;
  }
  const bool has_models = node.child("models") || root.name() == "models";
  const bool has_scene =
      node.child("arena") || node.child("framework") || node.child("physics_engines");
  if (has_scene) return true;
  if (has_models) {
    root.fault(
        "has models for scenes, but is no scene itself; run a scene with "
        "<include file=\"…\"/> of this file");
    return false;
  }
  const bool may_be_one = root.name() == "argos" || is_nearly_usual(root.name());
  if (may_be_one || node.child("controllers") || node.child("media")) return true;
  root.fault(
      "is no scene: it has neither <framework> nor <arena>; a scene begins with "
      "<argos-configuration>, "
      "which has both");
  return false;
}

/// A root may have any name; one that is nearly the usual one was meant to be it.
void doubt_root(Draft& draft, const Element& root) {
  if (root.name() == usual_root || !is_nearly_usual(root.name())) return;
  draft.report.warn(root.where(), "root",
                    fmt::format("the root element is <{}>; did you mean <{}>? It is read as one",
                                root.name(), usual_root));
}

/// Reports the settings that set nothing, and those that set more than one attribute.
void check_settings(Draft& draft, const Document& document) {
  for (std::size_t i = 0; i < draft.set.size(); ++i) {
    const Setting& setting = draft.options.variation.settings[i];
    const std::string option = to_string(setting);
    if (const Wrong* wrong = std::get_if<1>(&draft.set[i])) {
      draft.report.fault({}, fmt::format("{}: the path {}", option, wrong->text));
      continue;
    }
    const std::size_t count = std::get<0>(draft.set[i]);
    if (count == 0) {
      draft.report.fault(
          {}, fmt::format("{}: the path {}", option, why_nothing(document.root(), setting.path)));
    } else if (count > 1) {
      draft.report.notice({}, fmt::format("{} sets {} attributes", option, count));
    }
  }
}

void read_scene(Draft& draft, File file, const std::string& name) {
  const std::string_view text = trimmed(file.text);
  const bool is_script = name.ends_with(".lua") && !text.starts_with('<');
  if (!text.empty() && (is_script || text.find_first_of("<\0"sv) == std::string::npos)) {
    draft.scene.files.push_back(name);
    return draft.report.fault({}, no_xml(name));
  }
  Document& document = draft.add_document(std::move(file.text), name);
  if (!document.root()) return;
  Element root(document, document.root());
  if (!check_root(root, document.root())) return;
  doubt_root(draft, root);
  read_parameters(draft, root);
  Parts parts = read_includes(draft, root, file.identity);
  check_settings(draft, document);
  read_framework(draft, root);
  read_engines(draft, root);
  read_media(draft, root);
  read_controllers(draft, root, parts.controllers);
  read_directors(draft, root);
  for (Element& models : parts.models) read_models(draft, models);
  read_arena(draft, root);
  root.child_without_effect("visualization", "use the web viewer");
  root.done();
}

ReadResult refuse(const std::string& name, std::string text) {
  ReadResult result;
  result.scene.files = {name};
  result.problems = {{Problem::Severity::fault, name, {}, std::move(text)}};
  return result;
}

/// Each goes through all of the scene.
constexpr std::size_t most_settings = 256;

ReadResult read(File file, const std::string& name, const ReadOptions& options) {
  if (options.variation.settings.size() > most_settings) {
    return refuse(
        name,
        fmt::format("--set is given {} times; at most {} are allowed, so change the scene itself",
                    options.variation.settings.size(), most_settings));
  }
  ReadResult result;
  result.scene.variation = options.variation;
  Report report(result.scene.files);
  Draft draft(report, result.scene, options);
  try {
    read_scene(draft, std::move(file), name);
  } catch (const TooManyFaults&) {
    // The last fault says so.
  }
  result.problems = report.problems();
  result.additions = Additions(draft);
  return result;
}

}  // namespace

std::string text_of(const Problem& problem) { return text::shortened_message(problem.text); }

std::string to_string(const Problem& problem) {
  constexpr std::size_t longest_path = 4096;
  const std::string file = text::shortened(problem.file, longest_path), text = text_of(problem);
  if (problem.where.line == 0) return fmt::format("{}: {}", file, text);
  return fmt::format("{}:{}:{}: {}", file, problem.where.line, problem.where.column, text);
}

bool ReadResult::ok() const {
  return std::none_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.severity == Problem::Severity::fault;
  });
}

ReadResult read_text(std::string text, const std::string& name, const ReadOptions& options) {
  if (text.size() > options.max_size)
    return refuse(name, "the file " + too_large(options.max_size));
  const std::string identity = std::filesystem::path(name).lexically_normal().string();
  return read({identity, std::move(text)}, name, options);
}

ReadResult read_file(const std::filesystem::path& path, const ReadOptions& options) {
  auto opened = options.open(path, options.max_size);
  if (const std::string* why = std::get_if<std::string>(&opened)) {
    return refuse(path.string(), "the file " + *why);
  }
  return read(std::get<File>(std::move(opened)), path.string(), options);
}

SceneError::SceneError(std::vector<Problem> problems)
    : std::runtime_error([&problems] {
        std::string text;
        for (const Problem& problem : problems) {
          if (problem.severity != Problem::Severity::fault) continue;
          text += (text.empty() ? "" : "\n") + to_string(problem);
        }
        return text;
      }()),
      problems_(std::move(problems)) {}

}  // namespace ziggurat::scene
