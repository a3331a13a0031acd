// SPDX-License-Identifier: MIT
#include "cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/arguments.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

constexpr Command table[] = {
    {"run", "run a scene with its controllers", help_run, execute_run, run::by_run},
    {"view", "show a scene, a recording or a folder of scenes in a browser", help_view,
     execute_view},
    {"serve", "run a scene for controllers that connect from outside", help_serve, execute_serve,
     run::by_serve},
    {"check", "report every fault and notice of scene files", help_check, execute_check,
     run::by_check},
    {"render", "draw a scene at given times", help_render, execute_render, run::by_render},
    {"sweep", "run a scene with every combination of parameters and seeds", help_sweep,
     execute_sweep},
    {"replay", "repeat a recorded run, to the bit, without its controllers", help_replay,
     execute_replay, run::by_replay},
    {"fork", "go on live from a tick of a recorded run", help_fork, execute_fork, run::by_fork},
    {"verify", "check that a recorded run repeats to the bit", help_verify, execute_verify,
     run::by_verify},
    {"diff", "show where and how two recordings differ", help_diff, execute_diff},
    {"try", "compare a controller's commands with those of a recorded run", help_try, execute_try},
    {"export", "write a recording as CSV, JSON lines or a page", help_export, execute_export},
    {"magnetism", "plot force and torque between two magnets of a scene", help_magnetism,
     execute_magnetism},
    {"scenes", "list the scenes that come with the program", help_scenes, execute_scenes},
    {"new", "make a folder with a scene, a controller and a test", help_new, execute_new},
    {"info", "tell what a recording has, and whether it is whole", help_info, execute_info},
    {"keygen", "make a pair of keys that protect connections", help_keygen, execute_keygen},
    {"top", "show which controllers a run waits for", help_top, execute_top},
    {"ctl", "control a run: pause, step, reset, move, …", help_ctl, execute_ctl},
    {"help", "explain a command", help_help, execute_help},
};

}  // namespace

std::span<const Command> commands() { return table; }

const Command& command_named(const std::string& name) {
  const auto found = std::ranges::find(table, name, &Command::name);
  if (found != std::end(table)) return *found;
  if (name.ends_with(".argos") || name.ends_with(".xml")) {
    throw text::UsageError(
        fmt::format("there is no command '{0}'; to run a scene, write: ziggurat run {0}", name));
  }
  if (name.starts_with("--")) {
    const std::array<std::string, 2> options{"--version", "--help"};
    throw text::UsageError(fmt::format(
        "there is no option '{}' without a command; {}", name,
        text::advice(
            name, options,
            "write: ziggurat COMMAND [OPTION]..., where 'ziggurat help' lists the commands")));
  }
  if (name == "version" || name == "-v" || name == "-V") {
    throw text::UsageError(
        fmt::format("there is no command '{}'; write: ziggurat --version", name));
  }
  std::vector<std::string> names;
  for (const auto& command : table) names.emplace_back(command.name);
  throw text::UsageError(fmt::format("there is no command '{}'; {}", name,
                                     text::advice(name, names, "'ziggurat help' lists them")));
}

}  // namespace ziggurat::cli
