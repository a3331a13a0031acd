#pragma once
// The commands of the program: one table, one file per command.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reports/summary.h"

namespace ziggurat::cli {

/// What stands on the command line behind the command's name.
using Arguments = std::vector<std::string>;

namespace exit_code = reports::exit_code;

struct Command {
  std::string_view name;
  std::string_view summary;  ///< one line for the list of commands
  std::string (*help)();     ///< what `ziggurat help NAME` prints
  int (*execute)(const Arguments&);
};

std::span<const Command> commands();

/// The command with that name. @throws UsageError with a suggestion
const Command& command_named(const std::string& name);

std::string help_run();
std::string help_serve();
std::string help_check();
std::string help_render();
std::string help_keygen();
std::string help_magnetism();
std::string help_ctl();
std::string help_top();
std::string help_help();

/// Each returns an exit code and throws what main() turns into one.
int execute_run(const Arguments& arguments);
int execute_serve(const Arguments& arguments);
int execute_check(const Arguments& arguments);
int execute_render(const Arguments& arguments);
int execute_keygen(const Arguments& arguments);
int execute_magnetism(const Arguments& arguments);
int execute_ctl(const Arguments& arguments);
int execute_top(const Arguments& arguments);
int execute_help(const Arguments& arguments);

}  // namespace ziggurat::cli
