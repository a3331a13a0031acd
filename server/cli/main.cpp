// SPDX-License-Identifier: MIT
// The program `ziggurat`: finds the command, and turns what it throws into a message and an exit
// code. What belongs to the whole process, signals and limits, is set here and nowhere else.

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <variant>

#include "cli/commands.h"
#include "processes/guardian.h"
#include "processes/limits.h"
#include "processes/signals.h"
#include "reports/console.h"
#include "run/build.h"
#include "scene/reader.h"
#include "text/buffered_stream.h"
#include "text/numbers.h"
#include "text/printable.h"
#include "text/shortened.h"
#include "ziggurat/error.h"

namespace ziggurat::cli {
namespace {

bool asks_for_help(const Arguments& arguments) {
  const auto end = std::ranges::find(arguments, "--");
  return std::any_of(arguments.begin(), end,
                     [](const auto& each) { return each == "--help" || each == "-h"; });
}

/// Over a console of its own, as commands do: that of main() then can tell that stdout takes
/// nothing.
int tell_version() {
  reports::Console console;
  console.result(std::string("ziggurat ") + run::version);
  console.flush();
  return exit_code::finished;
}

int execute(const Command& command, const Arguments& arguments, std::span<char*> texts) {
  processes::check_stack();
  if (const auto* plain = std::get_if<Execute>(&command.execute)) return (*plain)(arguments);
  processes::check_limits();
  processes::Guardian guardian(texts);
  processes::Signals signals(&guardian);
  try {
    return std::get<ExecuteWithSignals>(command.execute)(arguments, signals);
  } catch (...) {
    signals.limit_what_follows();
    throw;
  }
}

/// @param texts  the arguments of main()
int dispatch(Arguments arguments, std::span<char*> texts, reports::Console& console) {
  if (arguments.empty()) {
    console.report(help_help());
    return exit_code::fault;
  }
  const std::string name = arguments.front();
  arguments.erase(arguments.begin());
  if (name == "--version" && !arguments.empty()) {
    throw text::UsageError(
        fmt::format("--version takes no '{}'; write: ziggurat --version", arguments.front()));
  }
  if (name == "--version") return tell_version();
  if (name == "--help" || name == "-h") return execute_help(arguments);
  const Command& command = command_named(name);
  if (asks_for_help(arguments)) {
    const bool is_whole = std::ranges::find(arguments, "--all") != arguments.end();
    return execute_help(is_whole ? Arguments{name, "--all"} : Arguments{name});
  }
  return execute(command, arguments, texts);
}

}  // namespace
}  // namespace ziggurat::cli

int main(int count, char** texts) {
  using namespace ziggurat;
  text::prepare_output();
  const cli::Arguments arguments(texts + std::min(count, 1), texts + count);
  reports::Console::Style style;
  style.json = std::ranges::find(arguments, "--json") != arguments.end();
  reports::Console console(style);
  processes::allow_many_files();
  try {
    return cli::dispatch(arguments, {texts, static_cast<std::size_t>(count)}, console);
  } catch (const scene::SceneError& error) {
    for (const auto& problem : error.problems()) console.problem(problem);
  } catch (const std::bad_alloc&) {
    console.fault("there is no memory left for the scene or for what was asked for");
  } catch (const std::filesystem::filesystem_error& error) {
    console.fault(fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::system_error& error) {
    const bool is_crowded =
        error.code() == std::errc::resource_unavailable_try_again;  // fork() and threads
    console.fault(text::shortened_message(error.what()) +
                  (is_crowded
                       ? "; the system allows this user no more processes and threads (ulimit -u)"
                       : ""));
  } catch (const ProtocolError& error) {
    console.fault(text::indented(text::shortened_message(error.what())));
  } catch (const std::exception& error) {
    console.fault(text::shortened_message(error.what()));
  }
  return cli::exit_code::fault;
}
