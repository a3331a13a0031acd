// SPDX-License-Identifier: MIT

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "rerun/replay_run.h"
#include "text/numbers.h"

namespace ziggurat::cli {

std::string help_replay() {
  return R"(usage: ziggurat replay RECORDING [OPTION]...

Repeats a run that 'ziggurat run --record RECORDING' has recorded: the same scene, commands and acts of
supervisors, without controllers. The hash of each state is compared with the recorded one.

  ziggurat replay run.mcap --view
      watch it; viewers can pause and step it, not change it
  ziggurat replay run.mcap --trace poses.csv --readings readings.jsonl
      write files that were not asked for when it ran
  ziggurat replay run.mcap --until 500 --hash
      up to tick 500
  ziggurat replay run.mcap --video run.mp4 --follow r1 --layers rays
      a film of it, and pictures with --out, as 'ziggurat render' makes them
  ziggurat replay run.mcap --from-poses --view
      show the recorded poses, without simulating

The recording alone is read: no file that its scene names, and none of its commands is started.

Exit codes: 0 all states are as recorded; 5 one differs; 6 the recording is damaged, what could be
read is as recorded; 1 fault of arguments or recording; 130 interrupted.
)";
}

int execute_replay(const Arguments& arguments, processes::Signals& signals) {
  rerun::ReplayOptions options;
  options.run = parse_options(arguments, run::by_replay);
  options.recording = only_recording("replay", options.run.scenes);
  const auto values = parse(arguments, options_of(run::by_replay)).values;
  options.from_poses = values.count("from-poses") > 0;
  if (values.count("until")) {
    options.until = text::to_integer("--until", values["until"].as<std::string>());
  }
  options.run.pictures = to_pictures(values);
  return rerun::ReplayRun(options, signals).execute();
}

}  // namespace ziggurat::cli
