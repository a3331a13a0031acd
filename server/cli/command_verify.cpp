// SPDX-License-Identifier: MIT

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "rerun/controller_check.h"
#include "rerun/replay_run.h"

namespace ziggurat::cli {
namespace {

int rehearse(const Parsed& parsed, const Arguments& arguments, processes::Signals& signals) {
  rerun::ControllerCheckOptions options;
  options.recording = only_recording("verify", parsed.positional);
  options.controllers = parse_options(arguments, run::by_verify).controllers;
  options.trusts_commands = parsed.values.count("trust-recorded-commands") > 0;
  options.quiet = parsed.values.count("quiet") > 0;
  return rerun::ControllerCheck(options, signals).execute();
}

}  // namespace

std::string help_verify() {
  return R"(usage: ziggurat verify RECORDING [OPTION]...

Repeats a recorded run without controllers and compares each state with the recorded one, to the bit.
Prints one line on stdout:

  identical: 601 states as recorded
  differs: tick 37: 'r', link 'arm': velocity.x is 0.1 in the recording, 0.2 now (hash …); 37 states …
  damaged: run.mcap: damaged at byte 81220: …; 120 states before it as recorded

A difference is followed by what may have caused it: another version, compiler or C library, other
instructions of the processor.

With --controllers the first command that differs is named, and the restarts and missed deadlines of the
recorded run as likely causes. A controller that does not compute the same from the same readings is
found so. With --quiet lines that controllers log are left out. Commands that the recording names are never started by themselves.

Exit codes: 0 identical; 5 differs; 6 damaged; 3 a controller failed or ended; 1 fault of arguments or recording; 130 interrupted.
)";
}

int execute_verify(const Arguments& arguments, processes::Signals& signals) {
  const Parsed parsed = parse(arguments, options_of(run::by_verify));
  const Values values(parsed.values);
  check_needs(values, {"controller", "trust-recorded-commands"}, "controllers");
  check_apart(values, "controllers", {"json"});
  if (values.has("controllers")) return rehearse(parsed, arguments, signals);
  rerun::ReplayOptions options;
  options.run = parse_options(arguments, run::by_verify);
  options.recording = only_recording("verify", options.run.scenes);
  options.verifies = true;
  return rerun::ReplayRun(options, signals).execute();
}

}  // namespace ziggurat::cli
