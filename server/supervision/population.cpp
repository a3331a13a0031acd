// SPDX-License-Identifier: MIT
#include "supervision/population.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "network/glob.h"
#include "processes/scripts.h"
#include "processes/spawned_scripts.h"
#include "scene/names.h"
#include "supervision/moves.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

using simulation::longest_spawned;
using simulation::most_spawned;
using wire::ErrorCode;

namespace {

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

/// The script of a robot that is back; empty if it has none, or none any more.
std::string script_of(const World& world, const scene::Entity& entity,
                      const processes::AllowedFiles& allowed, reports::Console& console) {
  try {
    const auto script = processes::spawned_script(world.scene, entity, world.path, allowed);
    if (script.fault) console.notice(script.details.value_or(*script.fault));
    return script.path;
  } catch (const std::runtime_error& error) {  // its file is gone
    console.notice(error.what());
    return {};
  }
}

}  // namespace

scene::OpenFile opener(const processes::AllowedFiles& allowed, const std::string& scene_file,
                       Spawned* spawned) {
  const auto scene_folder = std::filesystem::path(scene_file).parent_path();
  return
      [&allowed, spawned, scene_folder](const std::filesystem::path& path, std::size_t max_size) {
        std::vector<std::filesystem::path> candidates{path};
        for (const auto& folder : allowed.folders) {
          candidates.push_back(folder / path.lexically_relative(scene_folder));
        }
        for (const auto& candidate : candidates) {
          if (processes::is_below(allowed.folders, candidate)) {
            auto opened = scene::open_file(candidate, max_size);
            const auto* file = std::get_if<scene::File>(&opened);
            if (file && spawned) spawned->files.emplace_back(path.string(), file->text);
            return opened;
          }
        }
        return scene::open_no_file(path, max_size);
      };
}

wire::Fault no_entity(std::string field, const std::string& id,
                      const simulation::Simulation* world) {
  std::string text =
      fmt::format("There is no entity '{}'.", id.substr(0, network::longest_pattern));
  std::vector<std::string_view> ids;
  for (std::size_t i = 0; world != nullptr && i < world->layout().entities.size(); ++i) {
    if (!world->state().is_absent(i)) ids.push_back(world->layout().entities[i].id);
  }
  if (const auto meant = scene::nearest(id, ids))
    text += fmt::format(" Did you mean '{}'?", *meant);
  return wire::make_fault(ErrorCode::unknown_entity, std::move(field), std::move(text));
}

std::optional<std::size_t> entity_named(const simulation::Simulation& world,
                                        const std::string& id) {
  const auto& entities = world.layout().entities;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (entities[i].id == id && !world.state().is_absent(i)) return i;
  }
  return std::nullopt;
}

Population::Population(const Settings& settings, World& world, network::Server& server,
                       Callers& callers, processes::Controllers& controllers,
                       reports::Console& console)
    : settings_(settings),
      allowed_(processes::allowed_files(world.scene, world.path, settings.script_folders)),
      world_(world),
      server_(server),
      callers_(callers),
      controllers_(controllers),
      console_(console),
      size_left_(settings.max_size) {}

std::variant<Population::Candidate, wire::Fault> Population::read(
    const std::string& xml, const std::function<bool(const std::string&)>& is_taken,
    const EarlierSpawns& earlier) const {
  if (xml.size() > longest_spawned) {
    return wire::make_fault(ErrorCode::too_large, "spawn.xml",
                            fmt::format("The element has {} bytes; at most {} are allowed.",
                                        xml.size(), longest_spawned));
  }
  if (spawned_ + earlier.count >= most_spawned) {
    return wire::make_fault(
        ErrorCode::too_many, {},
        fmt::format("{} entities have been spawned, which is the limit; reset the world to "
                    "spawn more.",
                    most_spawned));
  }
  const network::ServerDirectors directors(server_);
  const auto is_used = [&](const std::string& id) { return is_taken(id) || directors.has(id); };
  Candidate candidate;
  candidate.spawned = {xml, {}, {}};
  scene::Addition& addition = candidate.addition;
  try {
    addition =
        world_.additions.read(xml, world_.scene, size_left_ - std::min(size_left_, earlier.size),
                              is_used, opener(allowed_, world_.path, &candidate.spawned));
    const scene::Entity& entity = addition.entity;
    if (addition.ok()) {
      candidate.script = processes::spawned_script(world_.scene, entity, world_.path, allowed_);
      candidate.spawned.script = candidate.script.path;
      if (candidate.script.details) console_.notice(*candidate.script.details);
      if (candidate.script.fault) {
        addition.problems.push_back({scene::Problem::Severity::fault,
                                     scene::file_of(world_.scene, entity.params_where),
                                     entity.params_where, *candidate.script.fault});
      }
    }
    if (addition.ok()) check_size(entity, addition.problems);
    if (!addition.ok()) throw scene::SceneError(addition.problems);
  } catch (const std::exception& error) {
    return wire::make_fault(ErrorCode::bad_value, "spawn.xml",
                            std::string(error.what()).substr(0, longest_message));
  }
  return candidate;
}

std::variant<std::string, wire::Fault> Population::overlapped(const wire::Request& request) const {
  const simulation::Simulation& world = world_.simulation;
  std::optional<std::size_t> itself;
  scene::Addition element;
  if (!request.is_element) {
    itself = entity_named(world, request.text);
    if (!itself) return no_entity("is_free.entity", request.text, &world);
  } else if (request.text.size() > longest_spawned) {
    return wire::make_fault(ErrorCode::too_large, "is_free.xml",
                            fmt::format("The element has {} bytes; at most {} are allowed.",
                                        request.text.size(), longest_spawned));
  } else {
    element = world_.additions.read_shape(request.text, world_.scene, settings_.max_size,
                                          opener(allowed_, world_.path));
    if (!element.ok()) {
      return wire::make_fault(
          ErrorCode::bad_value, "is_free.xml",
          std::string(scene::SceneError(element.problems).what()).substr(0, longest_message));
    }
  }
  auto pose = pose_of(itself ? world.state().origins[*itself] : math::Pose{}, request);
  if (auto* fault = std::get_if<wire::Fault>(&pose)) return std::move(*fault);
  const scene::Entity& entity = itself ? world.entities()[*itself] : element.entity;
  const auto other = simulation::overlapped_by(world, entity, std::get<math::Pose>(pose), itself);
  return other ? world.layout().entities[*other].id : std::string();
}

std::optional<wire::Fault> Population::spawn(const std::string& xml) {
  const auto is_taken = [this](const std::string& id) {
    return entity_named(world_.simulation, id).has_value();
  };
  auto read_element = read(xml, is_taken);
  if (auto* fault = std::get_if<wire::Fault>(&read_element)) return std::move(*fault);
  const Candidate& candidate = std::get<Candidate>(read_element);
  const scene::Entity& entity = candidate.addition.entity;
  try {
    world_.simulation.spawn(world_.scene, entity, xml);
  } catch (const std::exception& error) {  // the world is as it was
    return wire::make_fault(ErrorCode::bad_value, "spawn.xml",
                            std::string(error.what()).substr(0, longest_message));
  }
  for (const scene::Problem& notice : candidate.addition.problems) console_.problem(notice);
  callers_.tell(candidate.spawned);
  ++spawned_;
  sizes_[xml] = candidate.addition.size;
  size_left_ -= candidate.addition.size;
  const std::size_t robots = world_.simulation.layout().robots.size();
  if (entity.controller) add_controllers(robots - 1, std::array{candidate.script.path});
  return std::nullopt;
}

/// Gives the robots of the layout that came last their controllers: a Lua process if the run has
/// started those of the other robots, otherwise a client that connects.
/// @param first    of them
/// @param scripts  of their Lua controllers; empty if one has none
void Population::add_controllers(std::size_t first, std::span<const std::string> scripts) {
  const simulation::Simulation& simulation = world_.simulation;
  const auto& robots = simulation.layout().robots;
  server_.add_robots(scripts, simulation.observations(), simulation.state().tag_payloads);
  for (std::size_t i = first; i < robots.size(); ++i) {
    const std::array robot{i};
    const scene::Controller& controller = world_.scene.controllers[robots[i].controller];
    const bool is_lua = processes::runs_script(controller);
    const bool is_left_alone =
        settings_.leaves_libraries && scene::is_library(controller) && controller.command.empty();
    if (!settings_.with_controllers || (is_lua && scripts[i - first].empty()) || is_left_alone ||
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

std::optional<wire::Fault> Population::remove(const std::string& id) {
  const auto entity = entity_named(world_.simulation, id);
  if (!entity) return no_entity("remove.entity", id, &world_.simulation);
  std::vector<std::size_t> robots;
  const auto& all = world_.simulation.layout().robots;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].entity == *entity) robots.push_back(i);
  }
  world_.simulation.remove(*entity);
  callers_.tell(Removed{id});
  server_.remove_robots(robots, fmt::format("'{}' was removed from the world.", id));
  return std::nullopt;
}

/// Size of an element that was spawned, its model written out [bytes].
std::size_t Population::size_of(const std::string& xml) const {
  const auto is_free = [](const std::string&) { return false; };  // it is what is there
  const auto read = world_.additions.read(xml, world_.scene, settings_.max_size, is_free,
                                          opener(allowed_, world_.path));
  return std::max(read.size, xml.size());
}

/// Processes of robots that are gone end by themselves; robots that are back are free.
void Population::restart(std::size_t robots) {
  const simulation::Simulation& simulation = world_.simulation;
  spawned_ = 0;
  size_left_ = settings_.max_size;
  const auto known = std::exchange(sizes_, {});
  for (const simulation::WorldEdit& act : simulation.history().edits) {
    if (act.kind != simulation::WorldEdit::Kind::spawn) continue;
    ++spawned_;
    const auto found = known.find(act.xml);
    const std::size_t size = found != known.end() ? found->second : size_of(act.xml);
    sizes_[act.xml] = size;
    size_left_ -= std::min(size_left_, size);
  }
  const auto& all = simulation.layout().robots;
  controllers_.forget_robots(robots);
  std::vector<std::size_t> absent;
  for (std::size_t i = 0; i < robots; ++i) {
    if (simulation.state().is_absent(all[i].entity)) absent.push_back(i);
  }
  server_.remove_robots(absent);
  if (robots == all.size()) return;
  std::vector<std::string> scripts;
  for (std::size_t i = robots; i < all.size(); ++i) {
    scripts.push_back(script_of(world_, simulation.entities()[all[i].entity], allowed_, console_));
  }
  add_controllers(robots, scripts);
}

}  // namespace ziggurat::supervision
