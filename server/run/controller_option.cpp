#include "run/controller_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "processes/commands.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::run {

namespace {

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

void check_command(const std::string& id, const std::string& command) {
  const std::string wrong = processes::why_not_started(command);
  if (!wrong.empty())
    throw text::UsageError(fmt::format("--controller {}={}: {}", id, command, wrong));
}

void set_command(scene::Scene& scene, const std::string& id, const std::string& command) {
  const std::vector<std::size_t> replaced = awaited_named("--controller", id, scene);
  if (!command.empty()) check_command(id, command);
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

}  // namespace ziggurat::run
