// Entities that supervisors add to the world and remove from it (docs/protocol.md, V9 and V13).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "processes/scripts.h"
#include "processes/spawned_scripts.h"
#include "supervision/opener.h"
#include "supervision/supervision.h"
#include "wire/fault.h"

namespace ziggurat::supervision {

using wire::ErrorCode;

namespace {

constexpr std::size_t most_spawned = 10'000;                   // since the start or a reset
constexpr std::size_t longest_text = std::size_t{1} << 20;     // of an element [bytes]
constexpr std::size_t most_links = 256;                        // of an entity
constexpr double largest_mass = 1e6;                           // of an entity [kg]
constexpr std::size_t longest_message = std::size_t{1} << 14;  // of an error [bytes]

/// Faults of an entity that would make ticks too long, or push everything else away.
void check_size(const scene::Entity& entity, std::vector<scene::Problem>& problems) {
  const auto add = [&](std::string text) {
    problems.push_back({scene::Problem::Severity::fault, "spawn", entity.where, std::move(text)});
  };
  if (entity.links.size() > most_links) {
    add(fmt::format("'{}' has {} links; an entity that is spawned may have at most {}", entity.id,
                    entity.links.size(), most_links));
  }
  double mass = 0;
  for (const scene::Link& link : entity.links) mass += link.mass;
  if (mass > largest_mass) {
    add(fmt::format(
        "'{}' has a mass of {:.3g} kg; an entity that is spawned may have at most {:.0g} kg",
        entity.id, mass, largest_mass));
  }
}

}  // namespace

scene::OpenFile opener(const processes::AllowedFiles& allowed, const std::string& scene_file,
                       Spawned* act) {
  const auto scene_folder = std::filesystem::path(scene_file).parent_path();
  return [&allowed, act, scene_folder](const std::filesystem::path& path, std::size_t max_size) {
    std::vector<std::filesystem::path> candidates{path};
    for (const auto& folder : allowed.folders) {
      candidates.push_back(folder / path.lexically_relative(scene_folder));
    }
    for (const auto& candidate : candidates) {
      if (processes::is_below(allowed.folders, candidate)) {
        auto opened = scene::open_file(candidate, max_size);
        const auto* file = std::get_if<scene::File>(&opened);
        if (file && act) act->files.emplace_back(path.string(), file->text);
        return opened;
      }
    }
    return scene::open_no_file(path, max_size);
  };
}

Supervision::Reply Supervision::spawn(const network::Call& call) {
  const std::string& text = call.request.text;
  if (text.size() > longest_text) {
    return fail(call,
                wire::make_fault(ErrorCode::too_large, "spawn.xml",
                                 fmt::format("The element has {} bytes; at most {} are allowed.",
                                             text.size(), longest_text)));
  }
  if (spawned_ == most_spawned) {
    return fail(
        call,
        wire::make_fault(
            ErrorCode::too_many, {},
            fmt::format("{} entities have been spawned, which is the limit; reset the world to "
                        "spawn more.",
                        most_spawned)));
  }
  Spawned act{text, {}};
  scene::Addition addition = world_.additions.read(
      text, world_.scene, spawnable_size_,
      [this](const std::string& id) { return entity_named(world_.simulation, id).has_value(); },
      opener(allowed_, world_.path, &act));
  const scene::Entity& entity = addition.entity;
  processes::SpawnedScript script;
  try {
    if (addition.ok()) {
      script = processes::spawned_script(world_.scene, entity, world_.path, allowed_);
      if (script.details) console_.notice(*script.details);
      if (script.fault) {
        addition.problems.push_back({scene::Problem::Severity::fault,
                                     scene::file_of(world_.scene, entity.params_where),
                                     entity.params_where, *script.fault});
      }
    }
    if (addition.ok()) check_size(entity, addition.problems);
    if (!addition.ok()) throw scene::SceneError(std::move(addition.problems));
    world_.simulation.spawn(world_.scene, entity, text);
  } catch (const std::exception& error) {  // the world is as it was
    return fail(call, wire::make_fault(ErrorCode::bad_value, "spawn.xml",
                                       std::string(error.what()).substr(0, longest_message)));
  }
  for (const scene::Problem& notice : addition.problems) console_.problem(notice);
  callers_.tell(act);
  ++spawned_;
  spawnable_size_ -= addition.size;
  const std::size_t robots = world_.simulation.layout().robots.size();
  if (entity.controller) add_controllers(robots - 1, std::array{script.path});
  return done(call);
}

/// Gives the robots of the layout that came last their controllers: a Lua process if the run has
/// started those of the other robots, otherwise a client that connects.
/// @param first    of them
/// @param scripts  of their Lua controllers; empty if one has none
void Supervision::add_controllers(std::size_t first, std::span<const std::string> scripts) {
  const simulation::Simulation& simulation = world_.simulation;
  const auto& robots = simulation.layout().robots;
  server_.add_robots(scripts, simulation.observations(), simulation.state().tag_payloads);
  for (std::size_t i = first; i < robots.size(); ++i) {
    const std::array robot{i};
    const bool is_lua = processes::runs_script(world_.scene.controllers[robots[i].controller]);
    if (!settings_.with_controllers || (is_lua && scripts[i - first].empty()) ||
        simulation.state().is_absent(robots[i].entity)) {
      server_.remove_robots(robot);
      continue;
    }
    if (!is_lua) continue;
    try {
      controllers_.start_spawned(i, simulation.layout());
    } catch (const std::runtime_error& error) {
      console_.notice(error.what());  // the run then reports that it waits for a client to connect
    }
  }
}

Supervision::Reply Supervision::remove(const network::Call& call) {
  const std::string& id = call.request.text;
  const auto entity = entity_named(world_.simulation, id);
  if (!entity) return fail(call, no_entity("remove.entity", id));
  std::vector<std::size_t> robots;
  const auto& all = world_.simulation.layout().robots;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].entity == *entity) robots.push_back(i);
  }
  world_.simulation.remove(*entity);
  callers_.tell(Removed{id});
  server_.remove_robots(robots, fmt::format("'{}' was removed from the world.", id));
  return done(call);
}

}  // namespace ziggurat::supervision
