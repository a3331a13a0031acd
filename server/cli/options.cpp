#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/arguments.h"
#include "cli/variation.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

constexpr double longest_lease = 4e6;  // [s]
// Simulated seconds per second of wall time. At the least a tick of 0.1 s takes a day.
constexpr double least_factor = 1e-6, most_factor = 1e6;

double to_factor(const std::string& value) {
  const auto number = text::to_number("--real-time", value);
  if (!(number >= least_factor && number <= most_factor)) {
    throw text::UsageError(fmt::format("--real-time is {}; it must be {:g} to {:g}, 1 is real time",
                                       value, least_factor, most_factor));
  }
  return number;
}

scene::Clock to_clock(const std::string& value) {
  if (value == "nominal") return scene::Clock::nominal;
  if (value == "beta50") return scene::Clock::beta50;
  throw text::UsageError(fmt::format("--clock is '{}'; write nominal or beta50", value));
}

std::pair<std::string, std::string> to_controller(const std::string& value) {
  const auto equals = value.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == value.size()) {
    throw text::UsageError(fmt::format("--controller is '{}'; write ID=COMMAND", value));
  }
  return {value.substr(0, equals), value.substr(equals + 1)};
}

void read_length(const Values& values, run::Options& options) {
  constexpr std::uint64_t most_ticks = std::uint64_t{1} << 53;  // as in scenes
  if (values.has("ticks")) options.ticks = text::to_integer("--ticks", values.text("ticks"));
  if (options.ticks.value_or(0) > most_ticks) {
    throw text::UsageError(
        fmt::format("--ticks is {}; write at most 2^53, which is {}", *options.ticks, most_ticks));
  }
  if (values.has("duration")) {
    options.duration = text::to_number("--duration", values.text("duration"));
    if (*options.duration < 0) {
      throw text::UsageError("--duration is negative; write seconds, or 0 for until Ctrl-C");
    }
    check_time("--duration", *options.duration);
  }
  if (options.ticks && options.duration) {
    throw text::UsageError("--ticks and --duration both set the length; give one of them");
  }
}

/// For whom each option is, by name; without one for all.
template <class Option>
std::vector<std::string> controllers_of(const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& option : options) names.push_back(option.controller);
  return names;
}

/// Directions of several injections; an injection for both counts for each.
std::vector<std::string> directions_of(const std::vector<run::InjectOption>& options) {
  using network::Direction;
  std::vector<std::string> subjects;
  for (const run::InjectOption& option : options) {
    const std::string who = option.controller.empty() ? "" : option.controller + "=";
    if (option.direction != Direction::commands) subjects.push_back(who + "observations");
    if (option.direction != Direction::observations) subjects.push_back(who + "commands");
  }
  return subjects;
}

/// Each is for something: a second one for the same would replace the first.
void check_subjects(const run::Options& options) {
  check_once("--controller", first_of(options.controllers));
  check_once("--deadline", controllers_of(options.deadlines));
  check_once("--restart", controllers_of(options.restarts));
  check_once("--inject", directions_of(options.injections));
  check_once("--param", first_of(options.scene_file.variation.parameters));
  std::vector<std::string> paths;
  for (const scene::Setting& setting : options.scene_file.variation.settings)
    paths.push_back(setting.path);
  check_once("--set", std::move(paths));
}

/// Arguments for ziggurat-lua.
std::vector<std::string> lua_arguments(const Values& values) {
  std::vector<std::string> arguments;
  if (values.has("trust-scripts")) arguments.emplace_back("--trust-scripts");
  for (const auto& [option, passed] :
       {std::pair{"lua-memory", "--max-memory"},
        std::pair{"lua-instructions", "--max-instructions"}, std::pair{"lua-time", "--max-time"}}) {
    if (!values.has(option)) continue;
    constexpr std::uint64_t most = std::uint64_t{1} << 20;
    const auto number = text::to_integer(std::string("--") + option, values.text(option));
    if (number == 0 || number > most) {
      throw text::UsageError(
          fmt::format("--{} is {}; it must be from 1 to {}", option, number, most));
    }
    arguments.insert(arguments.end(), {passed, std::to_string(number)});
  }
  return arguments;
}

void read_controllers(const Values& values, run::Options& options) {
  options.lua_arguments = lua_arguments(values);
  if (values.has("lua-processes")) {
    constexpr std::uint64_t most = std::uint64_t{1} << 20;
    options.lua_processes = static_cast<unsigned>(
        std::min(text::to_integer("--lua-processes", values.text("lua-processes")), most));
  }
  for (const auto& each : values.texts("controller")) {
    options.controllers.push_back(to_controller(each));
  }
  options.fail_fast = values.has("fail-fast");
  options.allow_drops = values.has("allow-drops");
  options.without_controllers = values.has("without-controllers");
  for (const auto& each : values.texts("deadline")) {
    options.deadlines.push_back(run::to_deadline(each));
  }
  for (const auto& each : values.texts("inject")) {
    options.injections.push_back(run::to_injection(each));
  }
  for (const auto& each : values.texts("restart")) {
    options.restarts.push_back(run::to_restart(each));
  }
}

void read_network(const Values& values, run::Options& options) {
  options.endpoints = values.texts("endpoint");
  if (values.has("lease")) {
    options.lease = text::to_number("--lease", values.text("lease"));
    if (options.lease < 0 || options.lease > longest_lease) {
      throw text::UsageError(fmt::format("--lease is '{}'; it must be 0 to {} seconds",
                                         values.text("lease"), longest_lease));
    }
  }
  options.curve_secret = values.text("curve-secret");
  options.curve_clients = values.text("curve-clients");
  if (options.curve_secret.empty() != options.curve_clients.empty()) {
    throw text::UsageError("--curve-secret and --curve-clients need each other; give both");
  }
  options.insecure = values.has("insecure");
  options.allows_directors = values.has("allow-director");
  options.starts_directors = values.has("start-directors");
  options.paused = values.has("paused");
  options.ends_with_input = values.has("end-with-input");
  options.spawned_script_folders = values.texts("allow-spawned-scripts");
  options.snapshot_folder = values.text("snapshot-folder");
  options.metrics = values.text("metrics");
  if (values.has("view")) options.view = values.text("view");
  options.view_token = values.text("view-token");
  if (!options.view_token.empty() && !options.view) {
    throw text::UsageError("--view-token needs --view");
  }
}

void read_outputs(const Values& values, run::Options& options) {
  options.report_card = values.text("report-card");
  if (values.has("warm-up"))
    options.warm_up = text::to_integer("--warm-up", values.text("warm-up"));
  options.quiet = values.has("quiet");
  options.json = values.has("json");
  options.hash = values.has("hash");
  options.hash_file = values.text("hash-file");
  options.trace = values.text("trace");
  options.readings = values.text("readings");
  options.rays = values.text("rays");
  options.images = values.text("images");
  options.summary = values.text("summary");
}

/// Refuses options that have no effect without, or beside, another one.
void check_effects(const Values& values, const po::options_description& known,
                   const run::Options& options) {
  check_apart(values, "without-controllers",
              {"controller", "script", "restart", "trust-scripts", "trust-recorded-commands",
               "lua-processes", "lua-memory", "lua-instructions", "lua-time"});
  const auto is_tcp = [](const std::string& endpoint) { return endpoint.starts_with("tcp://"); };
  const bool has_address =
      std::ranges::any_of(options.endpoints, is_tcp) || options.view || !options.metrics.empty();
  if (!options.insecure || has_address) return;
  const bool has_endpoint = known.find_nothrow("endpoint", false) != nullptr;
  throw text::UsageError(fmt::format(
      "--insecure has no effect: it is for addresses that other machines can reach, and none is "
      "given; write {} too, or "
      "leave it out",
      has_endpoint ? "--endpoint tcp://HOST:PORT, --view=HOST:PORT or --metrics HOST:PORT"
                   : "--view=HOST:PORT"));
}

mcap::Compression to_compression(const std::string& value) {
  if (value == "zstd") return mcap::Compression::zstd;
  if (value == "lz4") return mcap::Compression::lz4;
  if (value == "none") return mcap::Compression::none;
  throw text::UsageError(
      fmt::format("--record-compression is '{}'; write zstd, lz4 or none", value));
}

void read_recording(const Values& values, run::Options& options) {
  options.record = values.text("record");
  for (const char* name :
       {"record-topics", "record-every", "record-compression", "record-paths", "record-strict"}) {
    if (values.has(name) && options.record.empty()) {
      throw text::UsageError(fmt::format("--{} needs --record FILE.mcap", name));
    }
  }
  options.record_topics = values.texts("record-topics");
  options.record_strict = values.has("record-strict");
  options.record_paths = values.has("record-paths");
  if (values.has("record-compression")) {
    options.record_compression = to_compression(values.text("record-compression"));
  }
  if (values.has("record-every")) {
    options.record_every = text::to_integer("--record-every", values.text("record-every"));
    if (options.record_every == 0) throw text::UsageError("--record-every is 0; write 1 or more");
  }
}

/// Without keys and tokens, and the paths of keys.
Arguments without_secrets(const Arguments& arguments) {
  Arguments kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string name = arguments[i].substr(0, arguments[i].find('='));
    const bool is_secret =
        name == "--view-token" || name == "--curve-secret" || name == "--curve-clients";
    if (!is_secret) {
      kept.push_back(arguments[i]);
    } else if (name == arguments[i]) {
      ++i;  // its value
    }
  }
  return kept;
}

unsigned to_threads(const std::string& text) {
  constexpr std::uint64_t most = 256;
  const std::uint64_t threads = text::to_integer("--threads", text);
  if (threads == 0 || threads > most)
    throw text::UsageError(fmt::format("--threads is {}; it must be from 1 to {}", threads, most));
  return static_cast<unsigned>(threads);
}

}  // namespace

void check_time(const char* option, double seconds) {
  constexpr double longest = 9e9;  // [s], as in scenes: nanoseconds fit 64 bits
  if (seconds > longest) {
    throw text::UsageError(fmt::format("{} is {:g} s; write at most {:g} simulated seconds", option,
                                       seconds, longest));
  }
}

run::Options parse_options(const Arguments& arguments, const po::options_description& known) {
  const Parsed parsed = parse(arguments, known);
  const Values values(parsed.values);
  run::Options options;
  options.scenes = parsed.positional;
  options.scene_file.lenient = values.has("lenient");
  if (values.has("max-scene-size")) {
    options.scene_file.max_size = text::to_size("--max-scene-size", values.text("max-scene-size"));
  }
  options.scene_file.variation = to_variation(values.texts("set"), values.texts("param"));
  read_length(values, options);
  if (values.has("seed")) options.seed = text::to_integer("--seed", values.text("seed"));
  if (values.has("clock")) options.scene_file.clock = to_clock(values.text("clock"));
  if (values.has("real-time")) {
    options.real_time = to_factor(values.text("real-time"));
  }
  if (values.has("threads")) options.threads = to_threads(values.text("threads"));
  options.strict = values.has("strict");
  options.hil = values.has("hil");
  if (values.has("gate")) options.gate = reports::parse_gate(values.text("gate"));
  read_controllers(values, options);
  read_network(values, options);
  read_outputs(values, options);
  read_recording(values, options);
  check_subjects(options);
  check_effects(values, known, options);
  options.arguments = without_secrets(arguments);
  return options;
}

}  // namespace ziggurat::cli
