#include "network/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "network/glob.h"
#include "wire/messages.h"

namespace ziggurat::network {
namespace {

using wire::ErrorCode;
using wire::make_fault;

enum class Fit { none, by_pattern, by_id };

/// Match of each robot of the layout with the ids and patterns.
std::variant<std::vector<Fit>, wire::Fault> fit_names(const std::vector<std::string>& names,
                                                      const world::Layout& layout) {
  std::vector<Fit> fits(layout.robots.size(), names.empty() ? Fit::by_pattern : Fit::none);
  std::unordered_map<std::string_view, std::size_t> positions;
  for (std::size_t i = 0; i < layout.robots.size(); ++i) positions[layout.robots[i].id] = i;
  std::size_t globs = 0;
  for (const std::string& name : names) {
    if (const auto found = positions.find(name); found != positions.end()) {
      fits[found->second] = Fit::by_id;
      continue;
    }
    if (!has_wildcards(name)) {
      const std::string id = name.substr(0, longest_pattern);
      return make_fault(ErrorCode::unknown_robot, "robots",
                        fmt::format("The scene has no robot '{}'.", id), id);
    }
    if (name.size() > longest_pattern || ++globs > most_patterns) {
      return make_fault(ErrorCode::too_many, "robots",
                        fmt::format("A Hello may have {} patterns of {} bytes at most.",
                                    most_patterns, longest_pattern));
    }
    const Glob glob(name);
    for (std::size_t i = 0; i < fits.size(); ++i) {
      if (fits[i] == Fit::none && glob.matches(layout.robots[i].id)) fits[i] = Fit::by_pattern;
    }
  }
  return fits;
}

}  // namespace

std::variant<std::vector<Selected>, wire::Fault> select_robots(const wire::Hello& hello,
                                                               const wire::Run& run) {
  if (hello.robots.empty() && hello.controller.empty() && !hello.lua_only) {
    return make_fault(ErrorCode::bad_value, "robots",
                      "A Hello says which robots it wants; '*' in `robots` is all of them.");
  }
  const auto is_wanted = [&](const scene::Controller& controller) {
    return controller.id == hello.controller;
  };
  if (!hello.controller.empty() &&
      std::none_of(run.controllers.begin(), run.controllers.end(), is_wanted)) {
    return make_fault(ErrorCode::unknown_controller, "controller",
                      fmt::format("The scene has no controller '{}'.",
                                  hello.controller.substr(0, longest_pattern)));
  }
  auto fitted = fit_names(hello.robots, run.layout);
  if (auto* fault = std::get_if<wire::Fault>(&fitted)) return std::move(*fault);
  const auto& fits = std::get<std::vector<Fit>>(fitted);
  std::vector<Selected> selected;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const scene::Controller& controller = run.controllers[run.layout.robots[i].controller];
    if (fits[i] == Fit::none) continue;
    if (!hello.controller.empty() && !is_wanted(controller)) continue;
    if (hello.lua_only && !controller.lua) continue;
    selected.push_back({i, fits[i] == Fit::by_id});
  }
  if (selected.empty()) {
    return make_fault(ErrorCode::unknown_robot, "robots",
                      run.layout.robots.empty()
                          ? "The scene has no robots: no entity has a controller."
                          : "No robot of the scene fits what the Hello asks for.");
  }
  return selected;
}

}  // namespace ziggurat::network
