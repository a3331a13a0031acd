// SPDX-License-Identifier: MIT
#include "rerun/controller_replay.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "recording/replay/recording_file.h"
#include "rerun/recorded_world.h"
#include "rerun/replay_difference.h"

namespace ziggurat::rerun {

using reports::Ending;

ControllerReplay::ControllerReplay(const replay::RecordingFile& file, supervision::World& recorded,
                                   const supervision::World& told, std::function<void()> follow,
                                   const Services& services, std::vector<bool> gone,
                                   ScriptOf script_of, TellDifference tell_difference)
    : file_(file),
      recorded_(recorded),
      told_world_(told),
      follow_(std::move(follow)),
      services_(services),
      gone_(std::move(gone)),
      script_of_(std::move(script_of)),
      tell_difference_(std::move(tell_difference)),
      states_(file_),
      replay_({recorded_.scene, recorded_.additions, recorded_.simulation, recorded_.seed},
              file_.files().opener(), [this] { return states_.next(); }) {
  replay_.tell([this](const v1::Act& act) { take(act); });
  replay_.open_snapshots_by(embedded_snapshots(file_, recorded_));
}

/// To the next state, which must be as recorded.
bool ControllerReplay::advance() {
  if (!replay_.advance()) {
    has_ended_ = true;
    return false;
  }
  if (replay_.is_same()) return true;
  throw replay::RecordingError("what controllers are given would differ: " +
                               explain_difference(file_, states_, replay_, recorded_));
}

std::optional<Ending> ControllerReplay::tell(const std::function<bool(std::uint64_t)>& is_end) {
  simulation::Simulation& simulation = recorded_.simulation;
  while (advance()) {
    const std::uint64_t tick = simulation.state().tick;
    if (is_end(tick)) break;
    if (is_restarted_) {
      if (const auto ending = restart()) return ending;
    }
    const wire::Truth truth{simulation.layout(), simulation.entities(), simulation.state(),
                            simulation.observations(), simulation.contacts()};
    services_.server.publish(simulation.observations(), simulation.state().tag_payloads, &truth);
    has_told_ = true;
    world::forget_sent(answered_);
    if (const auto ending = services_.watch.collect(answered_, tick)) return ending;
    const bool has_commands = replay_.inputs().has_commands();
    replay_.act();
    simulation.list_contacts(network::ServerDirectors(services_.server).wants_contacts());
    if (has_commands) compare();
  }
  if (!is_restarted_) take_shown();
  return std::nullopt;
}

/// Takes over devices that directors have shown and that no controller sets.
void ControllerReplay::take_shown() {
  const world::Layout& layout = recorded_.simulation.layout();
  const world::Commands& shown = recorded_.simulation.commands();
  auto robot = layout.robots.begin();  // they ascend by entity
  for (std::size_t entity = 0; entity < layout.entities.size(); ++entity) {
    if (robot != layout.robots.end() && robot->entity < entity) ++robot;
    const bool is_robot = robot != layout.robots.end() && robot->entity == entity;
    const auto copy = [&](const world::Range& devices, world::Range world::RobotLayout::*set,
                          const auto& from, auto& to) {
      if (is_robot && ((*robot).*set).count > 0) return;
      for (std::size_t i = devices.begin; i < devices.end(); ++i) to[i] = from[i];
    };
    const world::EntityLayout& has = layout.entities[entity];
    copy(has.leds, &world::RobotLayout::leds, shown.led_colors, answered_.led_colors);
    copy(has.directional_leds, &world::RobotLayout::directional_leds, shown.directional_led_colors,
         answered_.directional_led_colors);
    copy(has.tags, &world::RobotLayout::tags, shown.tag_payloads, answered_.tag_payloads);
  }
}

bool ControllerReplay::skip(const std::function<bool(std::uint64_t)>& is_end,
                            const std::function<bool()>& meanwhile) {
  is_told_ = false;
  while (advance()) {
    if (is_end(recorded_.simulation.state().tick)) break;
    replay_.act();
    if (!meanwhile()) return false;
  }
  return true;
}

/// All robots have a controller, which begins with this world.
std::optional<Ending> ControllerReplay::restart() {
  is_restarted_ = false;
  answered_ = recorded_.simulation.commands();
  world::forget_sent(answered_);
  return services_.watch.gather();
}

void ControllerReplay::take(const v1::Act& act) {
  const bool changes_population =
      act.has_reset() || act.has_restore() || act.has_spawn() || act.has_remove();
  if (follow_ && changes_population) follow_();
  if (act.has_reset()) take_reset();
  if (act.has_restore()) take_restore(act.restore().name());
  if (act.has_spawn()) take_spawn();
  if (act.has_remove()) remove_robot(act.remove().entity());
}

/// Controllers that were told nothing yet are not told of a reset either.
void ControllerReplay::take_reset() {
  answered_ = recorded_.simulation.commands();
  world::forget_sent(answered_);
  const std::size_t robots = told_world_.simulation.layout().robots.size();
  const bool has_fewer = robots < gone_.size();
  gone_.resize(robots);
  if (!is_told_ && !has_fewer) return;
  services_.server.restart({recorded_.seed});
  services_.controllers.forget_robots(robots);
  services_.watch.forget_spawned();
  is_restarted_ = true;
}

/// Restores controllers that were given nothing yet, as the server does for clients that connect
/// later.
void ControllerReplay::take_restore(const std::string& snapshot) {
  if (has_told_) {
    throw replay::RecordingError(fmt::format(
        "the run went back to the snapshot '{}', and controllers that are started now cannot; "
        "--fresh of 'ziggurat fork' starts them later",
        snapshot));
  }
  simulation::Simulation& simulation = recorded_.simulation;
  const std::size_t robots = replay_.common_robots();
  answered_ = simulation.commands();
  world::forget_sent(answered_);
  services_.server.restart(
      {recorded_.seed, {}, {{snapshot, simulation.state().tick, &answered_, robots}}});
  services_.controllers.forget_robots(robots);
  services_.watch.forget_spawned();
  gone_.resize(robots);
  for (std::size_t r = 0; r < robots; ++r) {
    if (!is_absent(r)) continue;
    gone_[r] = true;
    services_.server.remove_robots(std::array{r});
  }
  add_robots();
}

bool ControllerReplay::is_absent(std::size_t robot) const {
  const simulation::Simulation& simulation = recorded_.simulation;
  return simulation.state().is_absent(simulation.layout().robots[robot].entity);
}

/// The places of what was spawned begin with the values of the world.
void ControllerReplay::take_spawn() {
  const world::Commands& now = recorded_.simulation.commands();
  world::for_each_channel(world::commanded, [&](auto i) {
    constexpr auto& channel = std::get<i>(world::commanded);
    auto& values = answered_.*channel.values;
    const auto& all = now.*channel.values;
    values.insert(values.end(), all.begin() + static_cast<std::ptrdiff_t>(values.size()),
                  all.end());
  });
  add_robots();
}

/// Adds the robots that the layout has beyond the known ones.
void ControllerReplay::add_robots() {
  const world::Layout& layout = told_world_.simulation.layout();
  const std::size_t first = gone_.size();
  if (layout.robots.size() == first) return;
  std::vector<std::string> scripts;
  for (std::size_t robot = first; robot < layout.robots.size(); ++robot) {
    const auto script = script_of_(layout.robots[robot]);
    gone_.push_back(!script || is_absent(robot));
    scripts.push_back(script.value_or(""));
  }
  const simulation::Simulation& simulation = recorded_.simulation;
  services_.server.add_robots(scripts, simulation.observations(), simulation.state().tag_payloads);
  for (std::size_t robot = first; robot < layout.robots.size(); ++robot) {
    if (gone_[robot]) {
      services_.server.remove_robots(std::array{robot});
    } else if (!scripts[robot - first].empty()) {
      services_.controllers.start_spawned(robot, layout);
    }
  }
}

void ControllerReplay::remove_robot(const std::string& entity) {
  const world::Layout& layout = told_world_.simulation.layout();
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    if (layout.entities[layout.robots[r].entity].id != entity || gone_[r]) continue;
    gone_[r] = true;
    services_.server.remove_robots(std::array{r},
                                   fmt::format("'{}' was removed from the world.", entity));
  }
}

void ControllerReplay::compare() {
  const world::Layout& layout = recorded_.simulation.layout();
  const std::uint64_t tick = replay_.inputs().tick();
  bool has_compared = false;
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    if (gone_[r] || recorded_.simulation.state().is_absent(layout.robots[r].entity)) continue;
    has_compared = true;
    const auto found =
        replay::first_difference(layout, r, recorded_.simulation.commands(), answered_);
    if (!found) continue;
    const std::string& id = layout.robots[r].id;
    ++differences_.try_emplace(id, Difference{tick, 0}).first->second.ticks;
    if (tell_difference_) tell_difference_(tick, id, *found);
  }
  if (has_compared) ++ticks_;
}

}  // namespace ziggurat::rerun
