// SPDX-License-Identifier: MIT
#include "rerun/controller_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "processes/python_package.h"
#include "processes/scripts.h"
#include "recording/replay/recorded_log.h"
#include "recording/replay/recording_file.h"
#include "rerun/embedded_scripts.h"
#include "rerun/recorded_world.h"
#include "run/options/controller_option.h"
#include "run/setup.h"
#include "text/numbers.h"

namespace ziggurat::rerun {
namespace {

using processes::runs_script;

std::size_t robot_named(const world::Layout& layout, const std::string& id) {
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    if (layout.robots[r].id == id) return r;
  }
  throw text::UsageError(fmt::format("the recorded world has no robot '{}' at tick 0", id));
}

}  // namespace

ControllerCheck::ControllerCheck(const ControllerCheckOptions& options, processes::Signals& signals)
    : options_(options),
      signals_(signals),
      console_({.quiet = options.quiet, .mutes_controllers = options.quiet}),
      file_(options.recording),
      folder_(signals.guardian()),
      world_(build_world()),
      scripts_(embed_scripts()),
      server_(config(), run::description_of(world_, scripts_)),
      controllers_(start()),
      callers_(server_),
      population_({}, world_, server_, callers_, controllers_, console_),
      supervision_({}, world_, server_, callers_, population_),
      watch_({.metrics = {}, .ticks = file_.states(), .restarts = {}}, world_, server_,
             controllers_, supervision_, signals, console_, nullptr, [](auto...) {}) {}

supervision::World ControllerCheck::build_world() {
  if (options_.until) check_until(file_, *options_.until);
  return build_recorded(file_, [&](scene::Scene& scene) {
    for (const auto& [id, command] : options_.controllers)
      run::controller_named("--controller", id, scene);
    set_commands(scene, file_.run(), {options_.trusts_commands, options_.controllers});
    if (!options_.command.empty())
      scene.controllers[tried_controller(scene)].command = options_.command;
  });
}

/// The controller of the robot that is tried.
std::size_t ControllerCheck::tried_controller(const scene::Scene& scene) const {
  for (const scene::Entity& entity : scene.entities) {
    if (entity.id == *options_.robot && entity.controller) return *entity.controller;
  }
  for (const auto& group : scene.distributions) {
    if (options_.robot->starts_with(group.entity.id) && group.entity.controller) {
      return *group.entity.controller;
    }
  }
  throw text::UsageError(
      fmt::format("the recorded world has no robot '{}' with a controller", *options_.robot));
}

/// Per robot at tick 0: its embedded script as a file; the user's own for the one that is tried.
std::vector<std::string> ControllerCheck::embed_scripts() {
  begin_as_recorded(file_, world_);  // before anything is told who is in the world
  const std::string below = folder_.path() + "/files";
  write_below(below, file_.files());
  const world::Layout& layout = world_.simulation.layout();
  std::vector<std::string> scripts(layout.robots.size());
  const bool tries_one = options_.robot.has_value();
  const std::size_t tried = tries_one ? robot_named(layout, *options_.robot) : 0;
  for (std::size_t r = 0; r < scripts.size(); ++r) {
    if (tries_one && tried != r) continue;
    const bool is_own = !options_.script.empty();
    if (is_own && !runs_script(world_.scene.controllers[layout.robots[r].controller])) {
      throw text::UsageError("--script is for the robots of Lua controllers; write -- COMMAND");
    }
    scripts[r] =
        is_own ? std::filesystem::absolute(options_.script).string()
               : script_below(below, file_.files(), world_.scene, world_.path, layout.robots[r]);
  }
  return scripts;
}

bool ControllerCheck::is_checked(std::size_t robot) const {
  const world::RobotLayout& layout = world_.simulation.layout().robots[robot];
  if (options_.robot && layout.id != *options_.robot) return false;
  const scene::Controller& controller = world_.scene.controllers[layout.controller];
  if (!controller.command.empty()) return true;
  return runs_script(controller) && robot < scripts_.size() && !scripts_[robot].empty();
}

/// Nothing but the controllers' own time ends a wait: deadlines would change commands.
network::Config ControllerCheck::config() const {
  network::Config config;
  config.private_endpoint = "ipc://" + folder_.path() + "/run";
  config.deadlines.assign(world_.scene.controllers.size(), {.policy = {}, .is_fixed = true});
  return config;
}

std::vector<std::size_t> ControllerCheck::robots_without_controller() const {
  std::vector<std::size_t> robots;
  for (std::size_t r = 0; r < world_.simulation.layout().robots.size(); ++r) {
    const auto& recorded = file_.run().robots_without_controller();
    const bool had_none = std::ranges::find(recorded, r) != recorded.end();
    if (had_none || !is_checked(r)) robots.push_back(r);
  }
  return robots;
}

processes::Controllers ControllerCheck::start() {
  const auto without = robots_without_controller();
  const world::Layout& layout = world_.simulation.layout();
  if (without.size() == layout.robots.size()) {
    throw text::UsageError(
        "there is no controller to start: commands of a recording are started only if you write "
        "--controller ID=COMMAND, or --trust-recorded-commands");
  }
  gone_.assign(layout.robots.size(), false);
  for (const std::size_t robot : without) gone_[robot] = true;
  server_.remove_robots(without);
  processes::LaunchSettings settings{server_.endpoints().front(),  folder_.path(),
                                     processes::find_lua_runner(), 1,
                                     options_.lua_arguments,       signals_.guardian()};
  settings.scene_folder = folder_.path() + "/files";
  settings.python_path = processes::python_path(folder_.path());
  std::vector<std::string> folders{folder_.path() + "/files"};
  if (!options_.script.empty()) {
    folders.push_back(std::filesystem::absolute(options_.script).parent_path().string());
  }
  for (const std::string& folder : folders) {
    settings.lua_arguments.insert(settings.lua_arguments.end(), {"--script-folder", folder});
  }
  std::vector<std::string> scripts = scripts_;
  for (const std::size_t robot : without) scripts[robot].clear();
  return {world_.scene, layout, scripts, settings};
}

int ControllerCheck::execute() {
  std::optional<Ending> ending;
  try {
    ending = repeat();
  } catch (...) {
    watch_.end_run({wire::EndReason::failed, "the recording cannot be repeated",
                    world_.simulation.state().tick});
    throw;
  }
  watch_.end_run({wire::EndReason::finished, {}, world_.simulation.state().tick});
  const int code = tell(ending);
  console_.flush();
  signals_.completed(code);
  return code;
}

/// Nothing: the recording was repeated to its end.
std::optional<ControllerCheck::Ending> ControllerCheck::repeat() {
  const auto script_of = [this](const world::RobotLayout& robot) -> std::optional<std::string> {
    if (options_.robot) return std::nullopt;
    const std::string script =
        script_below(folder_.path() + "/files", file_.files(), world_.scene, world_.path, robot);
    return script.empty() ? std::nullopt : std::optional(script);
  };
  const auto tell = [this](std::uint64_t tick, const std::string& robot,
                           const replay::CommandDifference& found) {
    if (told_++ >= options_.most_told) return;
    console_.result(fmt::format("differs: tick {}: '{}': {} is {} in the recording, {} now", tick,
                                robot, found.device, found.recorded, found.now));
  };
  controller_replay_.emplace(file_, world_, world_, std::function<void()>(),
                             ControllerReplay::Services{server_, controllers_, watch_}, gone_,
                             script_of, tell);
  return controller_replay_->tell(
      [this](std::uint64_t tick) { return options_.until && tick > *options_.until; });
}

int ControllerCheck::tell(const std::optional<Ending>& ending) {
  if (const auto missing = file_.shortcoming(); !missing.empty()) console_.warning(missing);
  if (!watch_.vanished().empty()) console_.fault(watch_.vanished());
  const auto failures = watch_.reported().failures();
  for (const auto& [robot, difference] : controller_replay_->differences()) {
    console_.report(fmt::format("'{}': {} of {} ticks differ, the first is {}", robot,
                                difference.ticks, controller_replay_->ticks(),
                                difference.first_tick));
  }
  if (ending == Ending::interrupted || ending == Ending::forced) {
    return reports::exit_code::interrupted;
  }
  if (ending || !failures.empty()) return reports::exit_code::controller_failed;
  if (!controller_replay_->differences().empty()) {
    for (const auto& cause : replay::causes_of_commands(file_)) console_.result("  " + cause);
    return reports::exit_code::differs;
  }
  if (controller_replay_->ticks() == 0) {
    console_.fault(
        "nothing was compared: in the recorded run no such robot with a controller was stepped");
    return reports::exit_code::fault;
  }
  console_.result(fmt::format("identical: the commands of {} ticks are as recorded",
                              controller_replay_->ticks()));
  return reports::exit_code::finished;
}

}  // namespace ziggurat::rerun
