// SPDX-License-Identifier: MIT
#include "run/record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <type_traits>
#include <utility>
#include <variant>

#include "channels/channels.h"
#include "network/glob.h"
#include "outputs/output_file.h"
#include "processes/places.h"
#include "processes/required_scripts.h"
#include "processes/scripts.h"
#include "recording/recorder/recording.h"
#include "run/build.h"
#include "text/names.h"
#include "text/numbers.h"
#include "text/printable.h"
#include "text/shortened.h"

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;

/// The path as seen from where the scene file was named, so that recordings do not tell the folders
/// of their author.
std::string name_of_script(const fs::path& script, const std::string& scene_file) {
  const fs::path folder = fs::path(scene_file).parent_path();
  std::error_code error;
  const fs::path relative = fs::relative(script, folder.empty() ? fs::path(".") : folder, error);
  if (error || relative.empty()) return script.string();
  return (folder / relative).lexically_normal().string();
}

/// Folder of the scene file, as seen from which files are named: other names would tell the folders
/// of the author. Empty, if a file of the scene or a setting names one of its folders in full: that
/// one would not be found again.
std::string folder_to_hide(const recorder::Start& start) {
  const std::string folder = fs::path(start.scene).parent_path().string();
  const auto tells = [](std::string_view text, const std::string& path) {
    return path.starts_with('/') && text.find(path) != std::string_view::npos;
  };
  std::set<std::string> folders;
  for (const auto& file : start.files) {
    folders.insert(fs::path(file.name).parent_path().string() + "/");
  }
  const auto is_told = [&](const std::string& in) {
    const auto has_value = [&](const auto& each) { return tells(each.second, in); };
    return std::ranges::any_of(start.files,
                               [&](const auto& file) { return tells(file.text, in); }) ||
           std::ranges::any_of(start.settings, has_value) ||
           std::ranges::any_of(start.parameters, has_value);
  };
  if (std::ranges::any_of(folders, is_told)) return {};
  return folder;
}

/// Name of a file as seen from a folder; empty: as it is.
void name_from(const std::string& folder, std::string& name) {
  if (folder.empty() || folder.starts_with('/') != name.starts_with('/')) return;
  const fs::path relative =
      fs::path(name).lexically_normal().lexically_relative(fs::path(folder).lexically_normal());
  if (!relative.empty()) name = relative.string();
}

/// Attaches a script under a name that no other file has. One that cannot be read is left out.
void attach(const fs::path& script, std::string name, std::vector<recorder::EmbeddedFile>& files) {
  std::ifstream file(script, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.is_open() && !file.bad()) files.push_back({std::move(name), std::move(text)});
}

/// Adds what the scripts load, and tells of what is too much.
void add_required(std::vector<fs::path>& scripts, reports::Console& console) {
  for (const fs::path& folder : processes::add_required(scripts)) {
    console.notice(fmt::format(
        "some Lua files of {} are not in the recording: it takes 1000 at most, of 4 MiB each, and "
        "16 MiB of those "
        "whose names scripts compute; controllers that load others cannot be repeated from it",
        folder.string()));
  }
}

std::string clock_of(const Options& options) {
  if (!options.scene_file.clock) return {};
  return *options.scene_file.clock == scene::Clock::beta50 ? "beta50" : "nominal";
}

std::vector<recorder::Start::Controller> controllers_of(const supervision::World& world) {
  std::vector<recorder::Start::Controller> controllers;
  for (const scene::Controller& from : world.scene.controllers) {
    recorder::Start::Controller& to = controllers.emplace_back();
    to.id = from.id;
    to.command = from.command;
    const std::string script = processes::script_of(from.params);
    if (!processes::runs_script(from) || script.empty()) continue;
    const std::string file = scene::file_of(world.scene, from.params_where);
    const auto found = processes::find_file(script, file, world.path);
    to.script = found ? name_of_script(*found, world.path) : script;
  }
  return controllers;
}

std::function<bool(std::string_view)> wish_of(const std::vector<std::string>& patterns) {
  if (patterns.empty()) return {};
  return [patterns](std::string_view topic) {
    return std::ranges::any_of(
        patterns, [&](const std::string& each) { return network::matches(each, topic); });
  };
}

/// Topics that a recording of this world can have.
std::vector<std::string> topics_of(const supervision::World& world) {
  std::vector<std::string> topics{"/run", "/inputs", "/state"};
  channels::Channels channels;
  channels.populate({world.scene, world.path, world.scene_hash, world.seed, 0,
                     world.simulation.layout(), world.simulation.entities(),
                     world.simulation.state()});
  for (const channels::Channel& channel : channels.list()) {
    if (recorder::is_recorded(channel.kind)) topics.push_back(channel.topic);
  }
  return topics;
}

/// Whether it can fit the topic of a robot.
bool is_of_robots(std::string_view pattern) {
  constexpr std::string_view robots = "/robots/";
  const std::size_t exact = std::min(pattern.find_first_of("*?["), robots.size());
  return pattern.substr(0, exact) == robots.substr(0, exact);
}

/// Robots that are spawned later have topics that fit then: only a warning. @throws
/// text::UsageError
void check_topics(const std::vector<std::string>& patterns, const supervision::World& world,
                  reports::Console& console) {
  const std::vector<std::string> topics =
      patterns.empty() ? std::vector<std::string>() : topics_of(world);
  for (const std::string& pattern : patterns) {
    if (std::ranges::any_of(
            topics, [&](const std::string& topic) { return network::matches(pattern, topic); }))
      continue;
    const std::string told =
        fmt::format("--record-topics: '{}' fits no topic", text::shortened(pattern));
    if (is_of_robots(pattern)) {
      console.warning(told + " of this world; it is for robots that are spawned later, if any");
      continue;
    }
    throw text::UsageError(
        fmt::format("{}; {}", told,
                    text::advice(pattern, topics,
                                 "write /poses or '/robots/*', for example (docs/recordings.md)")));
  }
}

/// Names in a recording are UTF-8: others would not be found again. @throws text::UsageError
void check_names(const recorder::Start& start) {
  const auto check = [](const std::string& name) {
    if (!text::is_utf8(name))
      throw text::UsageError(
          fmt::format("{}: the name is not UTF-8, as names in a recording are; rename it", name));
  };
  check(start.scene);
  for (const recorder::EmbeddedFile& file : start.files) check(file.name);
}

recorder::Start start_of(const Options& options, const supervision::World& world,
                         const StartPoint& start_point, std::uint64_t last_tick,
                         const std::vector<std::size_t>& idle, reports::Console& console) {
  check_topics(options.record_topics, world, console);
  recorder::Start start;
  start.scene = world.path;
  start.scene_hash = world.scene_hash;
  start.seed = world.seed;
  start.lenient = options.scene_file.lenient;
  for (const auto& [path, value] : world.scene.variation.settings) {
    start.settings.emplace_back(path, value);
  }
  start.parameters = world.scene.variation.parameters;
  start.clock = clock_of(options);
  start.last_tick = last_tick;
  start.controllers = controllers_of(world);
  start.robots_without_controller = idle;
  start.date = fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  start.build = this_build();
  start.arguments = options.arguments;
  start_point.describe(world, start, console);
  check_names(start);
  return start;
}

}  // namespace

void add_scripts(const supervision::World& world, recorder::Start& start,
                 reports::Console& console) {
  std::vector<fs::path> scripts = processes::scripts_of(world.scene, world.path);
  add_required(scripts, console);
  for (const fs::path& script : scripts) {
    attach(script, name_of_script(script, world.path), start.files);
  }
}

RecordedRun::RecordedRun(const Options& options, supervision::World& world,
                         const StartPoint& start_point, std::uint64_t last_tick,
                         const std::vector<std::size_t>& idle, reports::Console& console)
    : world_(world),
      console_(console),
      last_tick_(last_tick),
      is_strict_(options.record_strict),
      recorder_({options.record,
                 options.record_compression,
                 {wish_of(options.record_topics), options.record_every}},
                begin(start_of(options, world, start_point, last_tick, idle, console),
                      options.record_paths)) {}

/// @param with_paths  names and the command line stay as they were written
recorder::Start RecordedRun::begin(recorder::Start start, bool with_paths) {
  if (!with_paths) {
    if (start.snapshot.empty())
      hidden_folder_ = folder_to_hide(start);  // else names are those of a recording
    start.arguments.clear();
  }
  name_from(hidden_folder_, start.scene);
  for (auto& controller : start.controllers) name_from(hidden_folder_, controller.script);
  for (auto& file : start.files) name_from(hidden_folder_, file.name);
  scene_name_ = start.scene;
  note(start.files);
  return start;
}

void RecordedRun::log(channels::Severity severity, std::string_view name, std::string_view text) {
  std::string shown(text);
  const std::string folder = hidden_folder_ + "/";
  const bool hides = hidden_folder_.starts_with('/');  // others tell nothing of the author
  for (std::size_t at = 0; hides && (at = shown.find(folder, at)) != std::string::npos;) {
    shown.erase(at, folder.size());
  }
  recorder_.log(severity, name, shown);
}

void RecordedRun::note(const std::vector<recorder::EmbeddedFile>& files) {
  for (const auto& file : files) embedded_.insert(fs::path(file.name).lexically_normal().string());
}

void RecordedRun::tick() {
  simulation::Simulation& simulation = world_.simulation;
  const auto* image = world::image_on(simulation.state().floor);
  is_population_new_ |= std::exchange(recorded_image_, image) != image;
  if (std::exchange(is_population_new_, false)) {
    recorder_.populate({world_.scene, scene_name_, world_.scene_hash, world_.seed, last_tick_,
                        simulation.layout(), simulation.entities(), simulation.state()});
  }
  recorder_.tick({simulation.state(),
                  simulation.observations(),
                  simulation.commands(),
                  simulation.contacts(),
                  {}});
  report_failure(fmt::format("the recording ends before tick {}", simulation.state().tick),
                 ", the run goes on");
}

void RecordedRun::close(const std::vector<world::Metric>& metrics) {
  recorder_.close(metrics);
  report_failure("the recording lacks its last ticks, or its end");
}

void RecordedRun::report_failure(const std::string& missing, const char* otherwise) {
  const auto why = recorder_.take_failure();
  if (!why) return;
  if (is_strict_) throw outputs::WriteError(*why);
  failure_ = fmt::format("{}; {}", *why, missing);
  console_.fault(failure_ + otherwise);
}

/// Embeds the script of a spawned robot, and the scripts that it loads. Scripts that the recording
/// has already are left out: they may have been edited since, but their robots began with the first
/// version.
void RecordedRun::add_script(const std::string& script,
                             std::vector<recorder::EmbeddedFile>& files) {
  if (script.empty() || !scripts_.insert(script).second) return;
  std::vector<fs::path> scripts{script};
  add_required(scripts, console_);
  for (const fs::path& each : scripts) {
    std::string name = name_of_script(each, world_.path);
    name_from(hidden_folder_, name);
    if (!embedded_.contains(name)) attach(each, std::move(name), files);
  }
}

void RecordedRun::record(const supervision::WorldChange& change) {
  recorder::Recorder& to = recorder_;
  std::visit(
      [&](const auto& made) {
        using Type = std::decay_t<decltype(made)>;
        if constexpr (std::is_same_v<Type, supervision::Moved>) {
          to.moved(made.entity, made.pose);
        } else if constexpr (std::is_same_v<Type, supervision::JointSet>) {
          to.joint_set(made.entity, made.joint, made.position, made.velocity);
        } else if constexpr (std::is_same_v<Type, supervision::Spawned>) {
          std::vector<recorder::EmbeddedFile> files;
          for (const auto& [name, text] : made.files) files.push_back({name, text});
          for (auto& file : files) name_from(hidden_folder_, file.name);
          add_script(made.script, files);
          note(files);
          to.spawned(made.xml, std::move(files));
          is_population_new_ = true;
        } else if constexpr (std::is_same_v<Type, supervision::Removed>) {
          to.removed(made.entity);
          is_population_new_ = true;
        } else if constexpr (std::is_same_v<Type, supervision::WasReset>) {
          to.reset(made.seed);
          is_population_new_ = true;
        } else if constexpr (std::is_same_v<Type, supervision::Restored>) {
          to.restored(made.snapshot, made.bytes);
          is_population_new_ = true;
        } else if constexpr (std::is_same_v<Type, supervision::SnapshotTaken>) {
          to.kept(made.snapshot);
        } else if constexpr (std::is_same_v<Type, supervision::Paused>) {
          to.set_paused(true);
        } else {
          static_assert(std::is_same_v<Type, supervision::Resumed>);
          to.set_paused(false);
        }
      },
      change);
}

}  // namespace ziggurat::run
