// Entities that supervisors add to the world and take out of it (docs/protocol.md, V9 and V13).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "processes/scripts.h"
#include "supervision/supervision.h"

namespace ziggurat::supervision {

using wire::ErrorCode;

namespace {

constexpr std::size_t most_spawned = 10'000;                     // since the start or a reset
constexpr std::size_t longest_text = std::size_t{1} << 20;       // of an element [bytes]
constexpr std::size_t longest_complaint = std::size_t{1} << 14;  // [bytes]

}  // namespace

Supervision::Reply Supervision::spawn(const network::Call& call) {
  const std::string& text = call.request.text;
  if (text.size() > longest_text) {
    return fail(
        call, ErrorCode::too_large, "spawn.xml",
        fmt::format("The element has {} bytes; {} are allowed.", text.size(), longest_text));
  }
  if (spawned_ == most_spawned) {
    return fail(
        call, ErrorCode::too_many, {},
        fmt::format("{} entities have been spawned; a reset makes room for more.", most_spawned));
  }
  scene::Addition addition = subject_.additions.read(
      text, subject_.scene, room_,
      [this](const std::string& id) { return entity_named(id).has_value(); });
  const scene::Entity& entity = addition.entity;
  try {
    if (addition.ok())
      std::ranges::move(processes::check_script(subject_.scene, entity, subject_.path),
                        std::back_inserter(addition.problems));
    if (!addition.ok()) throw scene::SceneError(std::move(addition.problems));
    subject_.simulation.spawn(subject_.scene, entity);
  } catch (const scene::SceneError& error) {
    return fail(call, ErrorCode::bad_value, "spawn.xml",
                std::string(error.what()).substr(0, longest_complaint));
  }
  for (const scene::Problem& notice : addition.problems) subject_.console.problem(notice);
  ++spawned_;
  room_ -= addition.size;
  if (entity.controller) employ(entity);
  return done(call);
}

/// Lets the last robot of the layout, which has just come, have its controller: a Lua process if
/// the run has started those of the others, else whoever connects.
void Supervision::employ(const scene::Entity& entity) {
  const simulation::Simulation& simulation = subject_.simulation;
  const std::array scripts{processes::script_path(subject_.scene, entity, subject_.path)};
  subject_.server.add_robots(scripts, simulation.observations(), simulation.state().tag_payloads);
  const std::array robot{simulation.layout().robots.size() - 1};
  const bool is_lua = processes::runs_script(subject_.scene.controllers[*entity.controller]);
  if (!subject_.with_controllers || (is_lua && scripts[0].empty())) {
    return subject_.server.remove_robots(robot);
  }
  if (!is_lua || !subject_.surroundings) return;
  try {
    auto started =
        processes::start_all({processes::plan_spawned(robot[0], launched_++, simulation.layout(),
                                                      *subject_.surroundings)},
                             simulation.layout());
    subject_.processes.push_back(std::move(started.front()));
  } catch (const std::runtime_error&) {
    // Whoever watches says that the world waits for somebody to connect.
  }
}

Supervision::Reply Supervision::remove(const network::Call& call) {
  const std::string& id = call.request.text;
  const auto entity = entity_named(id);
  if (!entity) {
    return fail(call, ErrorCode::unknown_entity, "remove.entity",
                fmt::format("There is no entity '{}'.", id));
  }
  std::vector<std::size_t> robots;
  const auto& all = subject_.simulation.layout().robots;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].entity == *entity) robots.push_back(i);
  }
  subject_.simulation.remove(*entity);
  subject_.server.remove_robots(robots, fmt::format("'{}' was removed from the world.", id));
  return done(call);
}

/// A reset has taken out all that was spawned. Processes of such robots end by themselves.
void Supervision::forget_spawned() {
  spawned_ = 0;
  room_ = subject_.room;
  const std::size_t robots = subject_.simulation.layout().robots.size();
  std::vector<processes::ControllerProcess> kept;
  for (processes::ControllerProcess& each : subject_.processes) {
    std::erase_if(each.robots, [&](std::size_t robot) { return robot >= robots; });
    if (each.robots.empty() && each.process.poll()) continue;
    kept.push_back(std::move(each));
  }
  subject_.processes = std::move(kept);
}

}  // namespace ziggurat::supervision
