// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/installed_scenes.h"
#include "reports/console.h"
#include "run/files.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description scenes_options() {
  po::options_description options("Options", 96);
  options.add_options()("names", "only the names, one a line")(
      "json", "an array on stdout, with name, path and sentence of each");
  return options;
}

std::string to_json(const std::vector<InstalledScene>& scenes) {
  auto all = nlohmann::ordered_json::array();
  for (const auto& scene : scenes)
    all.push_back({{"name", scene.name}, {"path", scene.path}, {"sentence", scene.sentence}});
  return all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string to_text(const std::vector<InstalledScene>& scenes) {
  std::size_t width = 0;
  for (const auto& scene : scenes) width = std::max(width, scene.name.size());
  std::string text;
  for (const auto& scene : scenes)
    text += fmt::format("{:<{}}  {}\n", scene.name, width, scene.sentence);
  return text + "\nziggurat run NAME --view shows one in a browser; the files are in " +
         run::shared_folder("scenes");
}

}  // namespace

std::string help_scenes() {
  return fmt::format(R"(usage: ziggurat scenes [OPTION]...

Lists the scenes that come with the program, with the first sentence of each. Commands that take a scene
take these names, too, where no file has the name.

  ziggurat scenes
  ziggurat run vehicle
      the installed scene of that name

{})",
                     fmt::streamed(scenes_options()));
}

int execute_scenes(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, scenes_options());
  const Values values(parsed.values);
  check_apart(values, "json", {"names"});
  if (!parsed.positional.empty()) {
    throw text::UsageError(fmt::format("unexpected '{}'; write: ziggurat scenes [--names | --json]",
                                       parsed.positional[0]));
  }
  const auto scenes = installed_scenes();
  if (scenes.empty()) {
    throw text::UsageError(fmt::format("no scenes are in {}: the installation is not whole",
                                       run::shared_folder("scenes")));
  }
  reports::Console console;
  if (values.has("names")) {
    for (const auto& scene : scenes) console.result(scene.name);
  } else {
    console.result(values.has("json") ? to_json(scenes) : to_text(scenes));
  }
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
