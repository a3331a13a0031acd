// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "rerun/fork.h"
#include "run/run.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

rerun::ForkOptions read_fork(const boost::program_options::variables_map& values) {
  rerun::ForkOptions fork;
  if (values.count("at") == 0) {
    throw text::UsageError("no tick is given; write --at TICK, a tick of the recording");
  }
  fork.at = text::to_integer("--at", values["at"].as<std::string>());
  fork.fresh = values.count("fresh") > 0;
  fork.trusts_commands = values.count("trust-recorded-commands") > 0;
  if (values.count("script") == 0) return fork;
  for (const std::string& each : values["script"].as<std::vector<std::string>>()) {
    const auto equals = each.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == each.size()) {
      throw text::UsageError(fmt::format("--script is '{}'; write NAME=FILE.lua", each));
    }
    fork.scripts.emplace_back(each.substr(0, equals), each.substr(equals + 1));
  }
  check_once("--script", first_of(fork.scripts));
  return fork;
}

}  // namespace

std::string help_fork() {
  return R"(usage: ziggurat fork RECORDING --at TICK [OPTION]...

Repeats a recorded run up to a tick and goes on live from there, with the same or with other controllers,
values and seed. The state at that tick is the recorded one, to the bit.

  ziggurat fork run.mcap --at 500 --ticks 1000 --trace other.csv
      the same again; with the same controllers the hashes are those of the recording
  ziggurat fork run.mcap --at 500 --script push.lua=gentle.lua
      another script from tick 500 on
  ziggurat fork run.mcap --at 500 --param gain=2 --set 'physics_engines/*/@default_friction=0.3'
      other values from tick 500 on; controllers have the new parameters from the beginning
  ziggurat fork run.mcap --at 500 --controller 'drive=./my-controller' --record other.mcap
      a program of yours; keep what follows

Controllers are first given what robots sensed in the recorded run, from its begin to that tick: their own
state is right then. What they answer is compared with the recorded commands and has no effect. With --fresh
they begin at that tick.

With other values and another seed, entities, links and ticks_per_second must stay as they are.

Embedded Lua scripts run sandboxed. Commands that the recording names are started only with
--trust-recorded-commands. Outputs begin at that tick. --ticks and --duration count from tick 0; without them
the fork ends when the recorded run was to end.

Exit codes: those of 'ziggurat run'.
)";
}

int execute_fork(const Arguments& arguments, processes::Signals& signals) {
  const Parsed parsed = parse(arguments, options_of(run::by_fork));
  const run::Options options = parse_options(arguments, run::by_fork);
  only_recording("fork", parsed.positional);
  rerun::Fork start(options, read_fork(parsed.values));
  return run::Run(options, start, run::Service::run, signals).execute();
}

}  // namespace ziggurat::cli
