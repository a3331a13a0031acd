// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "cli/installed_scenes.h"
#include "cli/settings_file.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

/// Commands whose other arguments are scenes; those of the rest are recordings.
constexpr unsigned of_scenes = run::by_run | run::by_serve | run::by_check | run::by_render;
constexpr unsigned width = 96;  // of the help [characters]

bool is_of(const run::Option& option, run::Commands command) {
  return (option.commands & command) != 0;
}

void describe(const run::Option& option, po::options_description& group) {
  const std::string text =
      std::string(option.text) + (is_repeated(option) ? "; may be repeated" : "");
  if (is_flag(option)) {
    group.add_options()(option.name, text.c_str());
  } else if (is_repeated(option)) {
    group.add_options()(
        option.name, po::value<std::vector<std::string>>()->value_name(option.value), text.c_str());
  } else {
    auto* value = po::value<std::string>()->value_name(option.value);
    if (option.implicit) value->implicit_value(option.implicit);
    group.add_options()(option.name, value, text.c_str());
  }
}

/// Its values as texts; of a flag an empty one.
std::vector<std::string> texts_of(const po::variable_value& value) {
  if (const auto* several = boost::any_cast<std::vector<std::string>>(&value.value()))
    return *several;
  const auto* one = boost::any_cast<std::string>(&value.value());
  return {one ? *one : std::string()};
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

/// Refuses options that have no effect without, or beside, another one.
void check_effects(const GivenOptions& given, run::Commands command, const run::Options& options) {
  const Values own(given.own.values), all(given.all);
  if (options.ticks && options.duration) {
    throw text::UsageError("--ticks and --duration both set the length; give one of them");
  }
  if (options.curve_secret.empty() != options.curve_clients.empty()) {
    throw text::UsageError("--curve-secret and --curve-clients need each other; give both");
  }
  if (!all.has("view")) check_needs(own, {"view-token"}, "view");
  if (!all.has("record")) {
    check_needs(
        own,
        {"record-topics", "record-every", "record-compression", "record-paths", "record-strict"},
        "record");
  }
  check_apart(own, "without-controllers",
              {"controller", "script", "restart", "trust-scripts", "trust-recorded-commands",
               "lua-processes", "lua-memory", "lua-instructions", "lua-time"});
  check_apart(own, "start-directors", {"without-directors"});
  const auto is_tcp = [](const std::string& endpoint) { return endpoint.starts_with("tcp://"); };
  const bool has_address =
      std::ranges::any_of(options.endpoints, is_tcp) || options.view || !options.metrics.empty();
  if (!options.insecure || has_address) return;
  const bool has_endpoint = is_of(*run::option_named("endpoint"), command);
  throw text::UsageError(fmt::format(
      "--insecure has no effect: it is for addresses that other machines can reach, and none is "
      "given; write {} too, or "
      "leave it out",
      has_endpoint ? "--endpoint tcp://HOST:PORT, --view=HOST:PORT or --metrics HOST:PORT"
                   : "--view=HOST:PORT"));
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

/// Adds what the command has and the command line does not say.
void add_settings(const std::string& path, run::Commands command, GivenOptions& given) {
  const Values own(given.own.values);
  const bool has_length = own.has("ticks") || own.has("duration");
  for (FileSetting& setting : read_settings_file(path)) {
    const std::string_view name = setting.option->name;
    const bool is_length = name == "ticks" || name == "duration";
    if (!is_of(*setting.option, command) || own.has(setting.option->name) ||
        (is_length && has_length))
      continue;
    if (setting.values.empty()) {
      given.switched_off.emplace_back(name);
    } else if (is_repeated(*setting.option)) {
      given.all.emplace(name, po::variable_value(setting.values, false));
    } else {
      given.all.emplace(name, po::variable_value(setting.values.front(), false));
    }
  }
}

}  // namespace

po::options_description options_of(run::Commands command, Detail detail) {
  po::options_description all("", width);
  for (const run::OptionGroup& group : run::option_groups()) {
    po::options_description part(group.heading, width);
    for (const run::Option& option : group.options) {
      const bool is_wanted = detail == Detail::all || option.use == run::Use::common;
      if (is_wanted && is_of(option, command)) describe(option, part);
    }
    if (!part.options().empty()) all.add(part);
  }
  return all;
}

std::string options_help(run::Commands command, std::string_view name, Detail detail) {
  std::ostringstream text;
  const auto shown = options_of(command, detail);
  text << shown;
  const std::size_t more = options_of(command).options().size() - shown.options().size();
  if (more > 0) text << fmt::format("\nand {} more: ziggurat help {} --all\n", more, name);
  return text.str();
}

GivenOptions read_given(const Arguments& arguments, run::Commands command) {
  GivenOptions given;
  given.own = parse(arguments, options_of(command));
  given.all = given.own.values;
  const Values own(given.own.values);
  if (own.has("settings")) add_settings(own.text("settings"), command, given);
  return given;
}

run::Options parse_options(const Arguments& arguments, run::Commands command) {
  const GivenOptions given = read_given(arguments, command);
  run::Options options;
  options.scenes = given.own.positional;
  if ((command & of_scenes) != 0) {
    for (std::string& scene : options.scenes) scene = scene_path(scene);
  }
  for (const run::OptionGroup& group : run::option_groups()) {
    for (const run::Option& option : group.options) {
      if (!is_of(option, command)) continue;
      const auto found = given.all.find(option.name);
      if (found != given.all.end()) {
        for (const std::string& value : texts_of(found->second)) apply(option, options, value);
      } else if (option.place == run::Place::scene &&
                 std::ranges::find(given.switched_off, option.name) == given.switched_off.end()) {
        options.open_to_scene.emplace_back(option.name);
      }
    }
  }
  check_subjects(options);
  check_effects(given, command, options);
  options.scene_file.run = run::run_attributes();
  options.arguments = without_secrets(arguments);
  return options;
}

}  // namespace ziggurat::cli
