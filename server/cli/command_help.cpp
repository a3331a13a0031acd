#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/commands.h"
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
  ziggurat help COMMAND        what a command does, with examples
  ziggurat --version           the version
)";
  return text;
}

int execute_help(const Arguments& arguments) {
  if (arguments.size() > 1) throw text::UsageError("one command at a time: ziggurat help COMMAND");
  reports::Console console;
  const auto text = arguments.empty() ? help_help() : command_named(arguments[0]).help();
  console.result(text.substr(0, text.find_last_not_of('\n') + 1));
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
