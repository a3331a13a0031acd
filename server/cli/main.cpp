// The program `ziggurat`: finds the command, and turns what it throws into a message and an exit
// code.

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <string>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "reports/console.h"
#include "run/version.h"
#include "scene/reader.h"

namespace ziggurat::cli {
namespace {

bool asks_for_help(const Arguments& arguments) {
  const auto end = std::ranges::find(arguments, "--");
  return std::any_of(arguments.begin(), end,
                     [](const auto& each) { return each == "--help" || each == "-h"; });
}

/// As many open files as we may have: each connection is one, and the usual 1024 would be fewer
/// than the sessions that the protocol promises room for.
void allow_many_connections() {
  rlimit limit;
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

int dispatch(Arguments arguments, reports::Console& console) {
  if (arguments.empty()) {
    console.report(help_help());
    return reports::exit_code::fault;
  }
  const std::string name = arguments.front();
  arguments.erase(arguments.begin());
  if (name == "--version") {
    console.result(std::string("ziggurat ") + run::version);
    console.flush();
    return reports::exit_code::finished;
  }
  if (name == "--help" || name == "-h") return execute_help({});
  const Command& command = command_named(name);
  if (asks_for_help(arguments)) return execute_help({name});
  return command.execute(arguments);
}

}  // namespace
}  // namespace ziggurat::cli

int main(int count, char** texts) {
  using namespace ziggurat;
  using namespace ziggurat::cli;
  const Arguments arguments(texts + std::min(count, 1), texts + count);
  reports::Console::Style style;
  style.json = std::ranges::find(arguments, "--json") != arguments.end();
  reports::Console console(style);
  allow_many_connections();
  try {
    return dispatch(arguments, console);
  } catch (const ziggurat::scene::SceneError& error) {
    for (const auto& problem : error.problems()) console.problem(problem);
  } catch (const std::exception& error) {
    console.fault(error.what());
  }
  return reports::exit_code::fault;
}
