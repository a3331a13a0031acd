#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
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
  ziggurat --version           the version
)";
  return text;
}

int execute_help(const Arguments& arguments) {
  const bool is_whole = arguments.size() == 2 && arguments[1] == "--all";
  if (arguments.size() > 1 && !is_whole) {
    throw text::UsageError(
        "one command at a time: ziggurat help COMMAND, or with all of its options: ziggurat help "
        "COMMAND --all");
  }
  reports::Console console;
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
