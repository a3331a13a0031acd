// SPDX-License-Identifier: MIT
#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <sstream>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "processes/commands.h"
#include "processes/scripts.h"
#include "rerun/controller_check.h"
#include "text/numbers.h"
#include "text/quoting.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description try_options() {
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  po::options_description options("Options", 96);
  options.add_options()                                                                 //
      ("robot", text("ID"), "the robot whose controller is tried; required")            //
      ("script", text("FILE.lua"), "of a Lua robot: the script, instead of a command")  //
      ("until", text("TICK"), "end after this tick")                                    //
      ("differences", text("N"), "print the first N ticks that differ; default 1")      //
      ("quiet", "the verdict alone: no progress, no notices, no lines of the controller");
  return options;
}

}  // namespace

std::string help_try() {
  std::ostringstream text;
  text << R"(usage: ziggurat try RECORDING --robot ID [OPTION]... -- COMMAND...
       ziggurat try RECORDING --robot ID --script FILE.lua [OPTION]...

Gives a controller what a robot has sensed in a recorded run, tick by tick, and compares what it
commands with the recorded commands. Its commands move nothing: a test of a new version of a controller
against a run that was good.

  ziggurat try run.mcap --robot r0 -- ./my-controller --fast
  ziggurat try run.mcap --robot r0 --script new.lua --differences 10

COMMAND is started as the scene's `command` would be: with ZIGGURAT_ENDPOINT and ZIGGURAT_CONTROLLER
in its environment. Prints each difference as `differs: ` with tick, device and both values, or
`identical: …`; after differences, what may have caused them: restarts and missed deadlines of the
recorded run. With --quiet nothing else is printed, also no line that the controller logs.

Exit codes: 0 identical; 5 a command differs; 3 the controller failed or ended; 1 fault of
arguments or recording; 130 interrupted.

)" << try_options();
  return text.str();
}

int execute_try(const Arguments& arguments, processes::Signals& signals) {
  const auto end = std::ranges::find(arguments, "--");
  const Parsed parsed = parse({arguments.begin(), end}, try_options());
  rerun::ControllerCheckOptions options;
  options.recording = only_recording("try", parsed.positional);
  const auto text = [&](const char* name) {
    return parsed.values.count(name) ? parsed.values[name].as<std::string>() : std::string();
  };
  options.robot = text("robot");
  if (options.robot->empty()) throw text::UsageError("no robot is given; write --robot ID");
  options.script = text("script");
  std::string command;
  for (auto word = end; word != arguments.end(); ++word) {
    if (word != end) command += (command.empty() ? "" : " ") + text::shell_word(*word);
  }
  if (command.empty() == options.script.empty()) {
    throw text::UsageError("write either -- COMMAND at the end, or --script FILE.lua");
  }
  if (const auto fault =
          command.empty() ? processes::compile_error(options.script) : std::nullopt) {
    throw text::UsageError("--script: " + *fault);
  }
  const std::string wrong = command.empty() ? std::string() : processes::why_not_started(command);
  if (!wrong.empty()) throw text::UsageError("COMMAND: " + wrong);
  options.command = command;
  options.quiet = parsed.values.count("quiet") > 0;
  if (parsed.values.count("until")) options.until = text::to_integer("--until", text("until"));
  if (parsed.values.count("differences")) {
    options.most_told = text::to_integer("--differences", text("differences"));
    if (options.most_told == 0) throw text::UsageError("--differences is 0; write 1 or more");
  }
  return rerun::ControllerCheck(options, signals).execute();
}

}  // namespace ziggurat::cli
