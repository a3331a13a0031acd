// SPDX-License-Identifier: MIT
#include "run/options/option_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "run/options/option_values.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

constexpr unsigned of_world = by_run | by_serve | by_fork, of_lua = by_run | by_fork | by_render,
                   of_scene = by_run | by_serve | by_render | by_check;
constexpr auto common = Use::common, rare = Use::rare;
constexpr auto command_line = Place::command_line, settings = Place::settings, scene = Place::scene;

constexpr Option run_options[] = {
    {"ticks", "N", of_world, common, settings, read_ticks, "N ticks instead of the scene's length"},
    {"duration", "S", of_world, common, settings, read_duration,
     "S simulated seconds instead of the scene's length; 0 is until Ctrl-C"},
    {"seed", "N", of_world | by_render, common, settings, read_seed,
     "random seed; 0 draws one from the system and prints it"},
    {"threads", "N", of_world, common, scene, read_threads,
     "N threads share the physics, with the same results for any number; default: one for 32 "
     "moving bodies, up to the processors, as local controllers wait meanwhile"},
    {"real-time", "FACTOR", of_world | by_replay, common, settings, read_real_time,
     "pace to the wall clock, FACTOR times as fast (default 1)", "1"},
    {"settings", "FILE.toml", of_world | by_render, common, command_line, &Options::settings_file,
     "options of that file, as lua-memory = 512; those of the command line win"},
    {"clock", "nominal|beta50", of_scene, rare, settings, read_clock,
     "physical time per tick: 1/ticks_per_second, or the slow clock of ARGoS 3.0.0-beta50"},
    {"paused", nullptr, of_world, rare, settings, &Options::paused,
     "stand at tick 0 until a supervisor resumes ('ziggurat ctl URL resume')"},
    {"end-with-input", nullptr, of_world, rare, settings, &Options::ends_with_input,
     "end, as with Ctrl-C, when standard input ends: a program that starts this one with a pipe "
     "does not leave it behind, however it ends itself"},
    {"fail-fast", nullptr, of_world, rare, settings, &Options::fail_fast,
     "end when the first controller fails or the first robot is dropped"},
    {"strict", nullptr, by_check, common, command_line, &Options::strict,
     "exit code 1 also for warnings"},
};

constexpr Option fork_options[] = {
    {"at", "TICK", by_fork, common, command_line, ByCommand{},
     "the recorded state from which it goes on: the first with this tick; required"},
    {"fresh", nullptr, by_fork, common, command_line, ByCommand{},
     "controllers begin at that tick; otherwise they are first given what robots sensed before, "
     "tick by tick"},
    {"script", "NAME=FILE.lua", by_fork, common, command_line, ByCommand{true},
     "FILE instead of the embedded script NAME ('ziggurat info' lists them)"},
    {"trust-recorded-commands", nullptr, by_fork | by_verify, common, command_line, ByCommand{},
     "start the commands that the recording names; they can do anything that you can do"},
    {"until", "TICK", by_replay, common, command_line, ByCommand{},
     "end at the first state with this tick"},
    {"from-poses", nullptr, by_replay, common, command_line, ByCommand{},
     "show the recorded poses and simulate nothing: with --view and --trace; what robots sense is "
     "not shown, and nothing is compared"},
    {"controllers", nullptr, by_verify, common, command_line, ByCommand{},
     "start the controllers, too, and compare what they command: embedded Lua scripts, sandboxed, "
     "and the commands of --controller"},
};

constexpr Option scene_file_options[] = {
    {"set", "PATH=VALUE", of_world | by_render | by_check, common, settings, Each{add_setting},
     "set the attributes that an XPath from the root element names, as in --set "
     "'physics_engines/dynamics3d/@iterations=7'"},
    {"param", "NAME=VALUE", of_world | by_render | by_check, common, settings, Each{add_parameter},
     "the value of a parameter of the scene's <parameters>, instead of its own"},
    {"lenient", nullptr, of_scene, rare, settings, set_lenient,
     "notices, not faults, for unknown attributes, libraries in C++ (their robots stand still), "
     "and "
     "devices and robots that are not modelled, which are left out"},
    {"max-scene-size", "SIZE", of_scene, rare, settings, read_scene_size,
     "largest scene file, as 64M (the default)"},
};

constexpr Option controller_options[] = {
    {"controller", "ID=CMD", of_lua | by_verify, common, settings, Each{add_controller},
     "start CMD for the controller ID"},
    {"without-controllers", nullptr, by_fork | by_render, common, command_line,
     &Options::without_controllers, "start no controllers; the robots do nothing"},
    {"start-directors", nullptr, by_serve, rare, settings, &Options::starts_all_directors,
     "a director of the scene that has no program to start is a fault; without it such a director "
     "connects from outside"},
    {"without-directors", nullptr, by_serve, rare, settings, &Options::starts_no_directors,
     "start no directors of the scene: they connect from outside, as controllers do"},
    {"restart", "[ID=]N", by_run | by_render, common, settings, Each{add_restart},
     "a process of the scene's controller ID (of any, without ID) that dies is started again, up "
     "to N times: it resumes its session at the present tick"},
    {"deadline", "[CONTROLLER=]ACTION[:MS[:BUDGET]]", of_world, common, settings,
     Each{add_deadline},
     "when a controller (all, if none is named) has not answered after MS milliseconds: wait, "
     "hold, zero, drop or stop; drop and stop hold the last command for BUDGET misses in a row "
     "first; hold and zero drop the robots after BUDGET misses"},
    {"lease", "S", of_world, rare, settings, read_lease,
     "when a controller disconnects, keep its robots for it for S seconds"},
    {"allow-drops", nullptr, of_world, rare, settings, &Options::allow_drops,
     "robots that a deadline dropped do not make the exit code 3"},
    {"allow-director", nullptr, of_world, rare, settings, &Options::allows_directors,
     "clients may direct the world although the scene has no <director> for them"},
};

constexpr Option lua_options[] = {
    {"lua-processes", "N", of_lua, common, scene, read_lua_processes,
     "share the Lua robots among N processes; default as many as --threads, if each has 64 robots; "
     "0 is one for each robot; spawned Lua robots share as many others, at most 16"},
    {"trust-scripts", nullptr, by_run | by_serve | by_render, common, settings, trust_scripts,
     "Lua scripts may start programs and use all of Lua and all files; otherwise they use only "
     "files below the folders of the scene, its includes and its scripts"},
    {"lua-memory", "MIB", of_lua | by_serve, rare, scene, read_lua_memory,
     "largest memory of a robot's Lua script; default 256"},
    {"lua-instructions", "MILLIONS", of_lua | by_serve, rare, scene, read_lua_instructions,
     "most Lua instructions of a robot at one tick, in millions; default 1000"},
    {"lua-time", "SECONDS", of_lua | by_serve, rare, scene, read_lua_time,
     "most processor time of a robot's Lua script at one tick; default 20"},
};

constexpr Option connection_options[] = {
    {"endpoint", "URL", of_world, common, settings, &Options::endpoints,
     "listen here too: tcp://127.0.0.1:5770, tcp://127.0.0.1:* or ipc:///short/path"},
    {"view", "HOST:PORT", of_world | by_replay, common, settings, read_view,
     "show it in a browser, Foxglove or Lichtblick: prints the address (default 127.0.0.1:8765, "
     "or a free port)",
     ""},
    {"insecure", nullptr, of_world | by_replay, common, settings, &Options::insecure,
     "allow addresses that other machines can reach"},
    {"metrics", "HOST:PORT", of_world, rare, settings, &Options::metrics,
     "serve the run's status over HTTP there: /metrics for Prometheus, /status as JSON"},
    {"allow-spawned-scripts", "DIR", of_world, rare, settings, &Options::spawned_script_folders,
     "robots that a supervisor spawns may use the scripts and files below DIR, too; otherwise "
     "only scripts that the scene names"},
    {"snapshot-folder", "DIR", of_world, rare, settings, &Options::snapshot_folder,
     "write the snapshots that supervisors take below DIR, and read them from there"},
};

constexpr Option key_options[] = {
    {"curve-secret", "FILE", of_world, rare, settings, &Options::curve_secret,
     "protect endpoints with this key ('ziggurat keygen')"},
    {"curve-clients", "FILE", of_world, rare, settings, &Options::curve_clients,
     "the allowed clients: lines KEY ROLE[,ROLE] [robots=GLOB,..] [controllers=GLOB,..] "
     "[takeover=yes|no] [NAME]; a ROLE is controller, director, supervisor or observer"},
    {"view-token", "TOKEN", of_world | by_replay, rare, settings, &Options::view_token,
     "the token of the address of --view instead of a random one: 16 characters or more"},
};

constexpr Option output_options[] = {
    {"quiet", nullptr, of_world | by_render | by_replay | by_check | by_verify, common, settings,
     &Options::quiet, "no progress, notices and summary on stderr"},
    {"json", nullptr, of_world | by_render | by_replay | by_check | by_verify, common, settings,
     &Options::json, "messages, or the result of check and verify, as JSON for programs"},
    {"hash", nullptr, of_world | by_replay, common, settings, &Options::hash,
     "last line of stdout: hash TICK DIGITS of the final state"},
    {"hash-file", "FILE", of_world | by_replay, rare, settings, &Options::hash_file,
     "the same line for every tick"},
    {"trace", "FILE.csv", of_world | by_replay, common, settings, &Options::trace,
     "world poses of everything at every tick"},
    {"readings", "FILE.jsonl", of_world | by_replay, common, settings, &Options::readings,
     "readings and commands of all robots at every tick"},
    {"rays", "FILE.jsonl", of_world | by_replay, rare, settings, &Options::rays,
     "tested rays and radio links of devices with show_rays"},
    {"images", "DIR", of_world | by_replay, rare, settings, &Options::images,
     "PNG per tick and camera with image: ROBOT.CAMERA.TICK.png"},
    {"summary", "FILE.json", of_world | by_replay, common, settings, &Options::summary,
     "the summary as JSON"},
};

constexpr Option record_options[] = {
    {"record", "FILE.mcap", of_world, common, settings, &Options::record,
     "everything: to replay the run to the bit, to look at it again (MCAP, as Foxglove reads it)"},
    {"record-topics", "PATTERN", of_world, rare, scene, &Options::record_topics,
     "only topics that match, as '/poses' or '/robots/r1*/*'; what a replay needs is always there"},
    {"record-every", "N", of_world, rare, scene, read_record_every,
     "pictures of every Nth tick only"},
    {"record-compression", "zstd|lz4|none", of_world, rare, scene, read_compression,
     "default zstd; lz4 is faster and larger"},
    {"record-paths", nullptr, of_world, rare, settings, &Options::record_paths,
     "record paths and the command line as they were written, not below the scene's folder"},
    {"record-strict", nullptr, of_world, rare, scene, &Options::record_strict,
     "end the run if the recording can't be written, as when the disk is full"},
};

constexpr Option hil_options[] = {
    {"hil", nullptr, by_run | by_serve, common, scene, &Options::hil,
     "pace to the wall clock and never wait: a controller that has not answered after nine tenths "
     "of a tick holds its last command, unless --deadline sets another policy"},
    {"inject", "[CONTROLLER=][DIRECTION:]WHAT", by_run | by_serve, rare, scene, Each{add_injection},
     "delay or lose messages, as a network does: latency=5ms,jitter=2ms,loss=1% to a controller "
     "(all, if none is named) and from it, or only in the DIRECTION observations or commands"},
    {"gate", "CONDITIONS", by_run | by_serve, rare, scene, read_gate,
     "exit with 4 unless every controller meets them: p99<2ms,misses<0.1% (p50, p90, p99, p99.9, "
     "max, jitter, misses, run: of misses in a row, late)"},
    {"report-card", "FILE", by_run | by_serve, rare, settings, &Options::report_card,
     "how controllers kept up, as JSON, as a picture if FILE ends with .svg, or tick by tick if it "
     "ends with .csv"},
    {"warm-up", "N", by_run | by_serve, rare, scene, read_warm_up,
     "the first N ticks do not count for the gate and the report card"},
};

constexpr unsigned of_pictures = by_render | by_replay;
constexpr Option picture_options[] = {
    {"out", "FILE.png", of_pictures, common, command_line, ByCommand{},
     "output file; for several pictures, %03d in it is the number"},
    {"at", "S,S,...", of_pictures, common, command_line, ByCommand{},
     "simulated seconds, one picture each (default 0)"},
    {"eye", "X,Y,Z", of_pictures, common, command_line, ByCommand{},
     "viewpoint [m] (default: the whole arena is in view)"},
    {"look-at", "X,Y,Z", of_pictures, common, command_line, ByCommand{},
     "point in the centre [m] (default: the middle of the arena)"},
    {"size", "WxH", of_pictures, common, command_line, ByCommand{}, "pixels (default 1280x720)"},
    {"fov", "DEGREES", of_pictures, common, command_line, ByCommand{},
     "angle from the left edge to the right edge (default 46)"},
    {"follow", "ENTITY", of_pictures, common, command_line, ByCommand{},
     "the view moves with this entity"},
    {"layers", "NAME,...", of_pictures, common, command_line, ByCommand{},
     "draw rays, frusta, labels, too"},
    {"video", "FILE", of_pictures, common, command_line, ByCommand{},
     "a film: .mp4, .webm, .webp or .gif; needs ffmpeg"},
    {"fps", "N", of_pictures, common, command_line, ByCommand{},
     "frames of the film per second (default 30)"},
    {"speed", "FACTOR", of_pictures, common, command_line, ByCommand{},
     "simulated seconds per second of the film (default 1)"},
    {"from", "S", of_pictures, common, command_line, ByCommand{},
     "its beginning in simulated seconds (default 0)"},
    {"to", "S", of_pictures, common, command_line, ByCommand{},
     "its end (default: the end of the scene)"},
};

constexpr OptionGroup groups[] = {
    {"The recorded run", "recorded", fork_options},
    {"Pictures and films", "pictures", picture_options},
    {"The run", "run", run_options},
    {"Reading the scene", "scene", scene_file_options},
    {"Controllers", "controllers", controller_options},
    {"Lua scripts", "lua", lua_options},
    {"Connections and viewers", "connections", connection_options},
    {"Keys", "keys", key_options},
    {"Outputs", "outputs", output_options},
    {"Recording", "recording", record_options},
    {"Hardware in the loop", "hil", hil_options},
};

/// In a scene.
std::string name_of_attribute(const Option& option) {
  std::string name = option.name;
  std::ranges::replace(name, '-', '_');
  return name;
}

const Option* option_of_attribute(std::string name) {
  std::ranges::replace(name, '_', '-');
  return option_named(name);
}

/// Each value of an attribute: of an option that may be repeated, several with white space between.
void apply_attribute(const Option& option, const std::string& value, Options& options) {
  if (is_flag(option) && value == "false") return;
  std::istringstream words(value);
  std::string word;
  if (!is_repeated(option)) return apply(option, options, value);
  while (words >> word) apply(option, options, word);
}

std::optional<std::string> wrong_attribute(const std::string& name, const std::string& value) {
  const Option& option = *option_of_attribute(name);
  if (is_flag(option) && value != "true" && value != "false") return "must be true or false";
  Options ignored;
  try {
    apply_attribute(option, value, ignored);
  } catch (const text::UsageError& error) {
    return fmt::format("is not taken: {}", error.what());
  }
  return std::nullopt;
}

}  // namespace

std::span<const OptionGroup> option_groups() { return groups; }

const Option* option_named(std::string_view name) {
  for (const OptionGroup& group : groups) {
    const auto found = std::ranges::find(group.options, name, &Option::name);
    if (found != group.options.end()) return &*found;
  }
  return nullptr;
}

bool is_flag(const Option& option) { return option.value == nullptr; }

bool is_repeated(const Option& option) {
  if (const auto* own = std::get_if<ByCommand>(&option.target)) return own->is_repeated;
  return std::holds_alternative<std::vector<std::string> Options::*>(option.target) ||
         std::holds_alternative<Each>(option.target);
}

void apply(const Option& option, Options& options, const std::string& value) {
  struct {
    Options& options;
    const std::string& value;
    void operator()(ByCommand) const {}
    void operator()(bool Options::*field) const { options.*field = true; }
    void operator()(std::string Options::*field) const { options.*field = value; }
    void operator()(std::vector<std::string> Options::*field) const {
      (options.*field).push_back(value);
    }
    void operator()(void (*read)(Options&, const std::string&)) const { read(options, value); }
    void operator()(Each each) const { each.read(options, value); }
  } const set{options, value};
  std::visit(set, option.target);
}

scene::RunAttributes run_attributes() {
  scene::RunAttributes attributes;
  for (const OptionGroup& group : groups) {
    for (const Option& option : group.options) {
      if (option.place == Place::scene) attributes.names.push_back(name_of_attribute(option));
    }
  }
  attributes.wrong = wrong_attribute;
  return attributes;
}

void apply_scene(const scene::Scene& scene, Options& options) {
  for (const auto& [name, value] : scene.run) {
    const Option* option = option_of_attribute(name);
    if (option != nullptr &&
        std::ranges::find(options.open_to_scene, option->name) != options.open_to_scene.end())
      apply_attribute(*option, value, options);
  }
}

}  // namespace ziggurat::run
