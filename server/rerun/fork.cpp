// SPDX-License-Identifier: MIT
#include "rerun/fork.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "processes/scripts.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/scene.h"
#include "rerun/embedded_scripts.h"
#include "rerun/recorded_world.h"
#include "run/files.h"
#include "run/loading.h"
#include "text/numbers.h"

namespace ziggurat::rerun {

using processes::runs_script;
using reports::Ending;

namespace {

/// Checks the names of all files before any is created.
std::string checked_recording(const run::Options& options) {
  run::check_files(options);
  return options.scenes.front();
}

/// Whether a state of one fits into the other.
bool have_same_layout(const world::Layout& a, const world::Layout& b) {
  const auto same = [](const auto& one, const auto& other) { return one.id == other.id; };
  return a.links.size() == b.links.size() && std::ranges::equal(a.entities, b.entities, same) &&
         std::ranges::equal(a.robots, b.robots, same);
}

}  // namespace

Fork::Fork(const run::Options& options, ForkOptions fork_options)
    : options_(options),
      fork_options_(std::move(fork_options)),
      file_(checked_recording(options)),
      files_(file_.files()) {
  use_own_scripts();
}

/// The only embedded file whose path ends so. @throws text::UsageError
std::string Fork::embedded_script(const std::string& name) const {
  std::vector<std::string> all, found;
  for (const auto& [path, bytes] : files_.all()) {
    if (!path.ends_with(".lua")) continue;
    all.push_back(path);
    if (path == name) return path;
    if (path.ends_with("/" + name)) found.push_back(path);
  }
  if (found.size() == 1) return found.front();
  throw text::UsageError(fmt::format("--script: the recording has {} '{}'; its scripts are: {}",
                                     found.empty() ? "no script" : "more than one script", name,
                                     fmt::join(all, ", ")));
}

void Fork::use_own_scripts() {
  for (const auto& [name, path] : fork_options_.scripts) {
    if (const auto fault = processes::compile_error(path))
      throw text::UsageError("--script: " + *fault);
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    files_.add(embedded_script(name), std::move(bytes));
  }
}

std::optional<std::uint64_t> Fork::last_tick(const scene::Scene& scene) const {
  const std::uint64_t recorded = file_.run().last_tick();  // 0: it was stopped
  const bool is_asked = options_.ticks || options_.duration;
  const auto tick =
      is_asked || recorded == 0 ? run::tick_count(options_, scene) : std::optional(recorded);
  if (tick && *tick < fork_options_.at) {
    throw text::UsageError(fmt::format(
        "--at {} is after the end of the run at tick {}; write --ticks with a later end",
        fork_options_.at, *tick));
  }
  return tick;
}

bool Fork::changes_world() const {
  const scene::Variation& variation = options_.scene_file.variation;
  return !variation.settings.empty() || !variation.parameters.empty() ||
         seed_ != file_.run().seed();
}

std::unique_ptr<supervision::World> Fork::build(const run::TellLoading& tell, reports::Console&) {
  tell(0, "The scene is being read.");
  const v1::RunStart& run = file_.run();
  seed_ = run::choose_seed(options_, run.seed());
  scene::OpenScene opened = replay::read_scene(run, files_, options_.scene_file.variation);
  set_commands(opened.scene, run, {fork_options_.trusts_commands, options_.controllers});
  const std::string hash =
      changes_world() ? replay::scene_hash(opened.scene, files_) : run.scene_hash();
  auto world = std::make_unique<supervision::World>(run.scene(), std::move(opened), seed_,
                                                    run::tell_steps(tell), hash);
  begin(*world);
  return world;
}

/// Puts the world of the fork into the recorded state.
void Fork::branch(supervision::World& world) const {
  world.branch(recorded_->simulation.snapshot(), options_.seed ? seed_ : recorded_->seed);
}

/// Puts the world where the recording begins, and checks that it can go on from recorded states.
void Fork::begin(supervision::World& world) {
  const bool has_other_values = changes_world();
  if (has_other_values) recorded_.reset(new supervision::World(build_recorded(file_)));
  supervision::World& recorded_world = recorded_ ? *recorded_ : world;
  begin_as_recorded(file_, recorded_world);
  if (!has_other_values) return;
  const auto refuse = [](const std::string& why) {
    throw replay::RecordingError(
        "--set, --param, --seed: the fork cannot go on from recorded states: " + why);
  };
  if (recorded_world.scene.experiment.ticks_per_second != world.scene.experiment.ticks_per_second) {
    refuse("ticks_per_second must stay as it is");
  }
  if (!have_same_layout(recorded_world.simulation.layout(), world.simulation.layout())) {
    refuse("it must have the same entities with the same links");
  }
  try {
    branch(world);
  } catch (const simulation::SnapshotError& error) {
    refuse(error.what());
  }
}

run::Programs Fork::programs(const supervision::World& world, const std::string& folder,
                             bool with_controllers) const {
  write_below(folder, files_);
  run::Programs programs;
  for (const world::RobotLayout& robot : world.simulation.layout().robots) {
    programs.scripts.push_back(script_below(folder, files_, world.scene, world.path, robot));
  }
  const auto& without = file_.run().robots_without_controller();
  programs.idle.assign(without.begin(), without.end());
  programs.folder = folder;
  programs.script_folders = {folder};
  if (!with_controllers) return programs;
  check_commands(world);
  programs.directors = directors(world, folder);
  return programs;
}

std::vector<scene::Director> Fork::directors(const supervision::World& world,
                                             const std::string& folder) const {
  std::vector<scene::Director> directors = world.scene.directors;
  for (scene::Director& director : directors) {
    if (director.script.empty() && director.command.empty() && options_.endpoints.empty()) {
      throw text::UsageError(
          fmt::format("the command of the director '{0}' is not started by itself; write "
                      "--controller {0}=COMMAND, "
                      "--trust-recorded-commands, or --endpoint where it connects",
                      director.id));
    }
    director.script = script_below(folder, files_, world.scene, world.path, director);
  }
  return directors;
}

/// Refuses controllers without a command that may be started, unless their robots had none.
void Fork::check_commands(const supervision::World& world) const {
  const auto& without = file_.run().robots_without_controller();
  const auto& robots = world.simulation.layout().robots;
  std::set<std::string> missing;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const scene::Controller& controller = world.scene.controllers[robots[r].controller];
    if (std::ranges::find(without, r) != without.end() || runs_script(controller)) continue;
    if (controller.command.empty()) missing.insert(controller.id);
  }
  if (!missing.empty() && options_.endpoints.empty()) {
    throw text::UsageError(
        fmt::format("the commands of the recording are not started by themselves; for each of "
                    "these controllers "
                    "write --controller ID=COMMAND: {}; or --trust-recorded-commands, or "
                    "--endpoint where they connect",
                    fmt::join(missing, ", ")));
  }
}

std::optional<Ending> Fork::reach(const Parts& parts) {
  supervision::World& world = parts.world;
  supervision::World& recorded_world = recorded_ ? *recorded_ : world;
  std::vector<bool> gone(world.simulation.layout().robots.size());
  for (const std::size_t robot : parts.without_controller) gone[robot] = true;
  const auto script_of = [&](const world::RobotLayout& robot) -> std::optional<std::string> {
    const std::string script =
        script_below(parts.programs.folder, files_, world.scene, world.path, robot);
    const bool is_lua = runs_script(world.scene.controllers[robot.controller]);
    return options_.without_controllers || (is_lua && script.empty()) ? std::nullopt
                                                                      : std::optional(script);
  };
  const auto follow = [&] {
    if (recorded_) branch(world);
  };
  ControllerReplay controller_replay(file_, recorded_world, world, follow,
                                     {parts.server, parts.controllers, parts.watch},
                                     std::move(gone), script_of, {});
  const auto is_there = [this](std::uint64_t tick) { return tick == fork_options_.at; };
  using clock = std::chrono::steady_clock;
  auto last_look = clock::now();
  const auto meanwhile = [&] {  // clients are heard while nothing is asked of them
    if (clock::now() - last_look < std::chrono::milliseconds(200)) return true;
    parts.server.gather({std::chrono::milliseconds(0), {}});
    last_look = clock::now();
    return parts.signals.take().interruptions == 0;
  };
  if (fork_options_.fresh) {
    if (!controller_replay.skip(is_there, meanwhile)) return Ending::interrupted;
  } else if (const auto ending = controller_replay.tell(is_there)) {
    return ending;
  }
  if (controller_replay.has_ended()) {
    if (file_.states() == 0) {
      throw text::UsageError("the recording holds no tick: the run ended before its first");
    }
    throw text::UsageError(
        fmt::format("--at {}: the recording has no such tick, it ends at tick {}", fork_options_.at,
                    recorded_world.simulation.state().tick));
  }
  follow();
  if (const world::Commands* commanded = controller_replay.commanded()) {
    world.simulation.commands() = *commanded;  // values stay until a controller changes them
    world::forget_sent(world.simulation.commands());
    world.simulation.commands().pushes.clear();
    world.simulation.commands().floor_paints.clear();
  }
  if (!fork_options_.fresh) report(controller_replay, parts.console);
  return std::nullopt;
}

void Fork::report(const ControllerReplay& controller_replay, reports::Console& console) const {
  const auto& differences = controller_replay.differences();
  if (differences.empty()) {
    return console.notice(fmt::format(
        "up to tick {} the controllers command what they did in the recording", fork_options_.at));
  }
  constexpr std::size_t most = 5;
  std::vector<std::string> robots;
  for (const auto& [robot, difference] : differences) {
    if (robots.size() == most) break;
    robots.push_back(fmt::format("'{}' from tick {} on, in {} of {} ticks", robot,
                                 difference.first_tick, difference.ticks,
                                 controller_replay.ticks()));
  }
  if (differences.size() > most) {
    robots.push_back(fmt::format("and {} more robots", differences.size() - most));
  }
  console.notice(
      fmt::format("up to tick {} the controllers command otherwise than in the recording, whose "
                  "commands were applied: {}",
                  fork_options_.at, fmt::join(robots, "; ")));
}

void Fork::describe(const supervision::World& world, recorder::Start& start,
                    reports::Console&) const {
  const v1::RunStart& run = file_.run();
  start.lenient = run.lenient();
  start.clock = run.clock();
  start.snapshot = "begin";
  for (const auto& [name, bytes] : files_.all()) start.files.push_back({name, bytes});
  const auto snapshot =
      simulation::to_bytes(world.simulation.snapshot(), {world.scene_hash, start.build.version});
  start.files.push_back({"snapshot/" + start.snapshot,
                         {reinterpret_cast<const char*>(snapshot.data()), snapshot.size()}});
}

}  // namespace ziggurat::rerun
