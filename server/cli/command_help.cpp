// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <span>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/scene_reference.h"
#include "reports/console.h"
#include "text/numbers.h"

namespace ziggurat::cli {

std::string help_help() {
  std::string text = R"(usage: ziggurat COMMAND [ARGUMENT]...

Ziggurat runs robots in lock-step with controllers that are programs of their own.

)";
  for (const auto& command : commands()) {
    text += fmt::format("  {:<10} {}\n", command.name, command.summary);
  }
  text += R"(
  ziggurat run SCENE --view    run a scene and watch it in a browser
  ziggurat help COMMAND        what a command does, with examples; --all: and with all of its options
  ziggurat help scene [NAME]   elements and attributes of scene files, or of the elements called NAME
  ziggurat --version           the version
)";
  return text;
}

int execute_help(const Arguments& arguments) {
  reports::Console console;
  if (!arguments.empty() && arguments[0] == "scene") {
    console.result(scene_reference(std::span(arguments).subspan(1)));
    console.flush();
    return reports::exit_code::finished;
  }
  const bool is_whole = arguments.size() == 2 && arguments[1] == "--all";
  if (arguments.size() > 1 && !is_whole) {
    throw text::UsageError(
        "one command at a time: ziggurat help COMMAND, or with all of its options: ziggurat help "
        "COMMAND --all");
  }
  std::string text = help_help();
  if (!arguments.empty()) {
    const Command& command = command_named(arguments[0]);
    text = command.help();
    if (command.options) {
      text += options_help(*command.options, command.name, is_whole ? Detail::all : Detail::common);
    }
  }
  console.result(text.substr(0, text.find_last_not_of('\n') + 1));
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
