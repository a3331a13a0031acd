// SPDX-License-Identifier: MIT
#pragma once
// The commands of the program: one table, one file per command.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "processes/signals.h"
#include "reports/summary.h"
#include "run/options/option_table.h"

namespace ziggurat::cli {

namespace exit_code = reports::exit_code;

/// The command line after the name of the command.
using Arguments = std::vector<std::string>;

/// Both return an exit code, and throw what main() prints as a message.
using Execute = int (*)(const Arguments&);
/// For commands that end in good order on a signal; the others are ended by it.
using ExecuteWithSignals = int (*)(const Arguments&, processes::Signals&);

struct Command {
  std::string_view name;
  std::string_view summary;  ///< one line for the list of commands
  std::string (*help)();     ///< what `ziggurat help NAME` prints
  std::variant<Execute, ExecuteWithSignals> execute;
  /// Its options are those of run/option_table.h, which follow on the help; none: in the help.
  std::optional<run::Commands> options = {};
};

std::span<const Command> commands();

/// The command with that name. @throws text::UsageError with a suggestion
const Command& command_named(const std::string& name);

std::string help_run();
std::string help_serve();
std::string help_check();
std::string help_render();
std::string help_sweep();
std::string help_scenes();
std::string help_new();
std::string help_info();
std::string help_fork();
std::string help_replay();
std::string help_verify();
std::string help_diff();
std::string help_try();
std::string help_export();
std::string help_keygen();
std::string help_magnetism();
std::string help_ctl();
std::string help_top();
std::string help_help();
std::string help_view();

int execute_run(const Arguments& arguments, processes::Signals& signals);
int execute_serve(const Arguments& arguments, processes::Signals& signals);
int execute_check(const Arguments& arguments);
int execute_render(const Arguments& arguments, processes::Signals& signals);
int execute_sweep(const Arguments& arguments, processes::Signals& signals);
int execute_scenes(const Arguments& arguments);
int execute_new(const Arguments& arguments);
int execute_info(const Arguments& arguments);
int execute_fork(const Arguments& arguments, processes::Signals& signals);
int execute_replay(const Arguments& arguments, processes::Signals& signals);
int execute_verify(const Arguments& arguments, processes::Signals& signals);
int execute_diff(const Arguments& arguments);
int execute_try(const Arguments& arguments, processes::Signals& signals);
int execute_export(const Arguments& arguments);
int execute_keygen(const Arguments& arguments);
int execute_magnetism(const Arguments& arguments);
int execute_ctl(const Arguments& arguments);
int execute_top(const Arguments& arguments, processes::Signals& signals);
int execute_help(const Arguments& arguments);
int execute_view(const Arguments& arguments, processes::Signals& signals);

}  // namespace ziggurat::cli
