// SPDX-License-Identifier: MIT
#include "run/options/controller_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>

#include "processes/commands.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::run {

namespace {

constexpr std::uint64_t most_times = 1'000'000;

[[noreturn]] void refuse(std::string_view option, std::string_view what, const std::string& id,
                         const std::vector<std::string>& ids) {
  const std::string known =
      ids.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(ids, ", "));
  throw text::UsageError(fmt::format("{}: the scene has no {} '{}'; {}", option, what, id,
                                     text::advice(id, ids, known)));
}

}  // namespace

std::size_t controller_named(std::string_view option, const std::string& id,
                             const scene::Scene& scene) {
  std::vector<std::string> ids;
  for (const scene::Controller& controller : scene.controllers) {
    if (controller.id == id) return ids.size();
    ids.push_back(controller.id);
  }
  refuse(option, "controller", id, ids);
}

std::vector<std::string> ids_of_awaited(const scene::Scene& scene) {
  std::vector<std::string> ids;
  for (const scene::Controller& controller : scene.controllers) ids.push_back(controller.id);
  for (const scene::Director& director : scene.directors) ids.push_back(director.id);
  return ids;
}

std::vector<std::size_t> awaited_named(std::string_view option, const std::string& id,
                                       const scene::Scene& scene) {
  const std::vector<std::string> ids = ids_of_awaited(scene);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == id) places.push_back(i);
  }
  if (places.empty()) refuse(option, "controller or director", id, ids);
  return places;
}

void set_command(scene::Scene& scene, const std::string& id, const std::string& command) {
  const std::vector<std::size_t> replaced = awaited_named("--controller", id, scene);
  const std::string wrong = command.empty() ? "" : processes::why_not_started(command);
  if (!wrong.empty())
    throw text::UsageError(fmt::format("--controller {}={}: {}", id, command, wrong));
  for (const std::size_t i : replaced) {
    if (i < scene.controllers.size()) {
      scene.controllers[i].command = command;
      continue;
    }
    scene::Director& director = scene.directors[i - scene.controllers.size()];
    director.command = command;
    director.script.clear();
  }
}

RestartOption to_restart(const std::string& value) {
  RestartOption option;
  const auto equals = value.rfind('=');  // ids may contain one
  const bool has_name = equals != std::string::npos;
  if (has_name) option.controller = value.substr(0, equals);
  const std::uint64_t times =
      text::to_integer("--restart", has_name ? value.substr(equals + 1) : value);
  if ((has_name && option.controller.empty()) || times > most_times) {
    throw text::UsageError(fmt::format(
        "--restart is '{}'; write CONTROLLER=N or, for all controllers, N: 0 to {}, how often a "
        "process is started again",
        value, most_times));
  }
  option.times = static_cast<unsigned>(times);
  return option;
}

std::vector<unsigned> restarts_of(const std::vector<RestartOption>& options,
                                  const scene::Scene& scene) {
  std::vector<unsigned> restarts(scene.controllers.size());
  apply_by_controller("--restart", options, scene,
                      [&](const RestartOption& option, std::size_t controller) {
                        restarts[controller] = option.times;
                      });
  return restarts;
}

}  // namespace ziggurat::run
