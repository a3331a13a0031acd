// SPDX-License-Identifier: MIT
#include "supervision/directing.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "supervision/moves.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

using wire::ErrorCode;
using wire::make_fault;

/// The entities that are in the world, by id.
class Directing::Names {
 public:
  explicit Names(const simulation::Simulation& world) : world_(world) {}

  /// Into Layout::entities.
  std::optional<std::size_t> find(const std::string& id) {
    if (!is_read_) read();
    const auto found = places_.find(id);
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }
  void come() {
    if (is_read_) places_[world_.layout().entities.back().id] = world_.layout().entities.size() - 1;
  }
  void gone(const std::string& id) { places_.erase(id); }

 private:
  void read() {
    const auto& entities = world_.layout().entities;
    for (std::size_t i = 0; i < entities.size(); ++i) {
      if (!world_.state().is_absent(i)) places_[entities[i].id] = i;
    }
    is_read_ = true;
  }

  const simulation::Simulation& world_;
  std::unordered_map<std::string, std::size_t> places_;  // looked up only
  bool is_read_ = false;
};

/// The floor with what will be painted on it at the next step.
class Directing::Floor {
 public:
  explicit Floor(simulation::Simulation& world) : world_(world) {}

  std::optional<wire::Fault> paint(const world::FloorPaint& region) {
    auto& paints = world_.commands().floor_paints;
    if (!painted_) {
      painted_ = world_.state().floor;
      for (const world::FloorPaint& earlier : paints) world::paint(*painted_, earlier);
    }
    if (world::paint(*painted_, region)) {
      paints.push_back(region);
      return std::nullopt;
    }
    return make_fault(ErrorCode::too_many, "paint_floor",
                      fmt::format("The floor has {} painted regions; paint one that hides others "
                                  "wholly, for example all of the arena, and they are forgotten.",
                                  world::most_floor_paints));
  }

  /// An image covers the floor of the arena.
  std::optional<wire::Fault> lay(const wire::LayImage& act, const scene::Scene& scene) {
    auto image = world::floor_image(act.file);
    if (const auto* why = std::get_if<std::string>(&image)) {
      return make_fault(ErrorCode::bad_value, "paint_floor.image",
                        fmt::format("The image of the floor {}.", *why));
    }
    const auto ground = scene::ground_of(scene.arena);
    return paint({.center = ground.center,
                  .half_size = {ground.size[0] / 2, ground.size[1] / 2},
                  .image = std::get<0>(std::move(image))});
  }

 private:
  simulation::Simulation& world_;
  std::optional<std::vector<world::FloorPaint>> painted_;  // none: nothing is painted yet
};

namespace {

/// Acts that a director has asked for so far in a Direction.
struct Asked {
  std::set<std::string> removed, spawned;  // ids
  EarlierSpawns spawns;
};

/// The link that is pushed, into Layout::links.
std::variant<std::size_t, wire::Fault> pushed_link(const world::Layout& layout, std::size_t entity,
                                                   const wire::Push& push) {
  const world::Range& links = layout.entities[entity].links;
  if (push.link.empty()) return links.begin;
  for (std::size_t i = links.begin; i < links.end(); ++i) {
    if (layout.links[i].id == push.link) return i;
  }
  return make_fault(ErrorCode::unknown_entity, "push.link",
                    fmt::format("'{}' has no link '{}'.", push.entity, push.link.substr(0, 256)));
}

/// Checks the number of values for the devices of a kind.
/// @param is_set_by_robot  its controller sets them
std::optional<wire::Fault> check_values(std::size_t given, std::size_t devices,
                                        bool is_set_by_robot, const wire::Show& show,
                                        const char* field) {
  if (given == 0) return std::nullopt;
  if (given != devices) {
    return make_fault(ErrorCode::bad_value, fmt::format("show.{}", field),
                      fmt::format("'{}' has {} of these devices; {} values were given.",
                                  show.entity, devices, given));
  }
  if (!is_set_by_robot) return std::nullopt;
  return make_fault(ErrorCode::not_yours, fmt::format("show.{}", field),
                    fmt::format("The controller of '{}' sets these devices.", show.entity));
}

std::optional<wire::Fault> check_show(const world::Layout& layout, std::size_t index,
                                      const wire::Show& show) {
  const world::EntityLayout& entity = layout.entities[index];
  // Robots ascend by entity.
  const auto robot =
      std::ranges::lower_bound(layout.robots, index, {}, &world::RobotLayout::entity);
  const bool is_robot = robot != layout.robots.end() && robot->entity == index;
  auto fault = check_values(show.led_colors.size(), entity.leds.count,
                            is_robot && robot->leds.count > 0, show, "led_colors");
  if (!fault) {
    fault =
        check_values(show.directional_led_colors.size(), entity.directional_leds.count,
                     is_robot && robot->directional_leds.count > 0, show, "directional_led_colors");
  }
  if (!fault) {
    fault = check_values(show.tag_payloads.size(), entity.tags.count,
                         is_robot && robot->tags.count > 0, show, "tag_payloads");
  }
  return fault;
}

void apply_show(const world::EntityLayout& entity, const wire::Show& show,
                world::Commands& commands) {
  const auto copy = [](const auto& from, const world::Range& range, auto& to) {
    std::ranges::copy(from, to.begin() + static_cast<std::ptrdiff_t>(range.begin));
  };
  copy(show.led_colors, entity.leds, commands.led_colors);
  copy(show.directional_led_colors, entity.directional_leds, commands.directional_led_colors);
  copy(show.tag_payloads, entity.tags, commands.tag_payloads);
}

const std::string& id_of(const wire::DirectorAct& act) {
  if (const auto* show = std::get_if<wire::Show>(&act)) return show->entity;
  if (const auto* push = std::get_if<wire::Push>(&act)) return push->entity;
  return std::get<wire::Request>(act).text;
}

const char* name_of(const wire::DirectorAct& act) {
  if (std::holds_alternative<wire::Show>(act)) return "show";
  if (std::holds_alternative<wire::Push>(act)) return "push";
  switch (std::get<wire::Request>(act).kind) {
    case wire::Request::Kind::move:
      return "move";
    case wire::Request::Kind::set_joint:
      return "set_joint";
    default:
      return "remove";
  }
}

bool is_spawn(const wire::DirectorAct& act) {
  const auto* request = std::get_if<wire::Request>(&act);
  return request != nullptr && request->kind == wire::Request::Kind::spawn;
}

bool is_removal(const wire::DirectorAct& act) {
  const auto* request = std::get_if<wire::Request>(&act);
  return request != nullptr && request->kind == wire::Request::Kind::remove;
}

/// Checks an act on an entity that is there.
std::optional<wire::Fault> check_act(const simulation::Simulation& world, std::size_t entity,
                                     const wire::DirectorAct& act) {
  if (const auto* show = std::get_if<wire::Show>(&act)) {
    return check_show(world.layout(), entity, *show);
  }
  if (const auto* push = std::get_if<wire::Push>(&act)) {
    auto link = pushed_link(world.layout(), entity, *push);
    if (auto* fault = std::get_if<wire::Fault>(&link)) return std::move(*fault);
    return std::nullopt;
  }
  if (is_removal(act)) return std::nullopt;
  const wire::Request& request = std::get<wire::Request>(act);
  if (request.kind == wire::Request::Kind::set_joint) return check_joint(world, entity, request);
  auto pose = pose_of(world.state().origins[entity], request);
  if (auto* fault = std::get_if<wire::Fault>(&pose)) return std::move(*fault);
  return std::nullopt;
}

wire::Fault at(std::size_t act, wire::Fault fault) {
  fault.field = fmt::format("acts[{}]{}{}", act, fault.field.empty() ? "" : ".", fault.field);
  return fault;
}

}  // namespace

Directing::Directing(World& world, network::Server& server, Callers& callers,
                     Population& population, reports::Console& console)
    : world_(world),
      directors_(server),
      callers_(callers),
      population_(population),
      console_(console) {
  directors_.check_by([this](const wire::Direction& direction) { return check(direction); });
}

/// All acts are on entities that are there at the tick which is answered; those that the Direction
/// itself has removed before are not.
std::optional<wire::Fault> Directing::check(const wire::Direction& direction) const {
  Names names(world_.simulation);
  Asked asked;
  const auto is_taken = [&](const std::string& id) {
    const bool is_there = names.find(id).has_value() && !asked.removed.contains(id);
    return is_there || asked.spawned.contains(id);
  };
  for (std::size_t i = 0; i < direction.acts.size(); ++i) {
    const wire::DirectorAct& act = direction.acts[i];
    const bool is_on_floor = std::holds_alternative<world::FloorPaint>(act) ||
                             std::holds_alternative<wire::LayImage>(act);
    if (is_on_floor) continue;
    const std::string& id = id_of(act);
    if (is_spawn(act)) {
      auto read = population_.read(id, is_taken, asked.spawns);  // the text is the element
      if (auto* fault = std::get_if<wire::Fault>(&read)) return at(i, std::move(*fault));
      const auto& addition = std::get<Population::Candidate>(read).addition;
      asked.spawned.insert(addition.entity.id);
      ++asked.spawns.count;
      asked.spawns.size += addition.size;
      continue;
    }
    const auto entity = names.find(id);
    if (!entity || asked.removed.contains(id)) {
      return at(i, no_entity(fmt::format("{}.entity", name_of(act)), id, &world_.simulation));
    }
    if (auto fault = check_act(world_.simulation, *entity, act)) return at(i, std::move(*fault));
    if (is_removal(act)) asked.removed.insert(id);
  }
  return std::nullopt;
}

std::optional<reports::Summary::Result> Directing::result() const {
  for (const network::Directed& each : directors_.directions()) {
    if (each.direction.finish) {
      return reports::Summary::Result{each.director, *each.direction.finish};
    }
  }
  return std::nullopt;
}

std::optional<wire::Fault> Directing::apply(const wire::DirectorAct& act, Names& names,
                                            Floor& floor) {
  simulation::Simulation& simulation = world_.simulation;
  if (is_spawn(act)) {
    auto fault = population_.spawn(std::get<wire::Request>(act).text);
    if (!fault) names.come();
    return fault;
  }
  if (const auto* region = std::get_if<world::FloorPaint>(&act)) return floor.paint(*region);
  if (const auto* image = std::get_if<wire::LayImage>(&act)) return floor.lay(*image, world_.scene);
  const std::string& id = id_of(act);
  const auto entity = names.find(id);
  if (!entity) return no_entity(fmt::format("{}.entity", name_of(act)), id);
  if (auto fault = check_act(simulation, *entity, act)) return fault;
  if (const auto* show = std::get_if<wire::Show>(&act)) {
    apply_show(simulation.layout().entities[*entity], *show, simulation.commands());
  } else if (const auto* push = std::get_if<wire::Push>(&act)) {
    const auto link = std::get<std::size_t>(pushed_link(simulation.layout(), *entity, *push));
    const auto vector_of = [](const std::array<double, 3>& v) {
      return math::Vector3(v[0], v[1], v[2]);
    };
    simulation.commands().pushes.push_back({link, vector_of(push->force), vector_of(push->torque)});
  } else if (is_removal(act)) {
    auto fault = population_.remove(id);
    if (!fault) names.gone(id);
    return fault;
  } else {
    return move(simulation, callers_, *entity, std::get<wire::Request>(act));
  }
  return std::nullopt;
}

void Directing::act() {
  Names names(world_.simulation);
  Floor floor(world_.simulation);
  bool has_changed = false;
  for (const network::Directed& each : directors_.directions()) {
    for (std::size_t i = 0; i < each.direction.acts.size(); ++i) {
      auto fault = apply(each.direction.acts[i], names, floor);
      has_changed = true;
      if (!fault) continue;
      note_left_out(each.director, fault->message);
      directors_.warn(each.director, at(i, std::move(*fault)));
    }
  }
  if (has_changed) callers_.note_change();
}

/// At once, unless the last notice is too fresh: then with the next one.
void Directing::note_left_out(const std::string& director, const std::string& why) {
  constexpr std::chrono::seconds between_notices{10};
  ++untold_;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_notice_) return;
  const auto others = untold_ == 1
                          ? std::string()
                          : fmt::format(" ({} acts were left out since the last line)", untold_);
  const std::string_view sentence(why.data(), why.find_last_not_of('\n') + 1);
  console_.notice(fmt::format("director '{}', tick {}: {}{}", director,
                              world_.simulation.state().tick, sentence, others));
  untold_ = 0;
  next_notice_ = now + between_notices;
}

}  // namespace ziggurat::supervision
