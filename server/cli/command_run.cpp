// SPDX-License-Identifier: MIT
#include <unistd.h>

#include "cli/commands.h"
#include "cli/options.h"
#include "run/run.h"

namespace ziggurat::cli {

std::string help_run() {
  return R"(usage: ziggurat run SCENE [OPTION]...

Runs a scene: starts its controllers as separate processes and advances the world tick by tick, in
lock-step with them, for the scene's length or, if that is 0, until Ctrl-C.

  ziggurat run vehicle.argos
      with everything as in the scene
  ziggurat run vehicle.argos --view
      the same, to watch in a browser: open the address that it prints
  ziggurat run vehicle.argos --duration 10 --trace poses.csv
      ten simulated seconds; writes all poses at every tick to poses.csv
  ziggurat run vehicle.argos --seed 7 --hash --quiet
      only controllers' lines and the hash of the state: equal seeds give equal hashes
  ziggurat run swarm.argos --lua-processes 2
      two processes share the Lua robots; 0 is one process for each robot
  ziggurat run vehicle.argos --controller 'drive=./my-controller --verbose'
      a program instead of a controller of the scene; its environment contains ZIGGURAT_ENDPOINT,
      the address of the server, and ZIGGURAT_CONTROLLER, the controller's id
  ziggurat run vehicle.argos --restart drive=3
      a process of the controller 'drive' that dies is started again, up to three times, with the token of
      its session in ZIGGURAT_SESSION_TOKEN
  ziggurat run vehicle.argos --endpoint tcp://127.0.0.1:5770
      an <external_controller> without a command may connect there

stdout has the lines that controllers log, as [TICK ROBOT] TEXT, and with --hash a last line with the
hash, nothing else. stderr has faults, notices, progress (on a terminal) and a summary.

Exit codes: 0 finished; 1 fault of scene, arguments or environment; 3 a controller failed, its
process ended, or a deadline dropped a robot; 4 the gate was missed; 130 interrupted. Ctrl-C, SIGTERM and
SIGHUP end the program within a second, also in the middle of a long tick; after a second one it does not
wait for controllers. Output files are complete up to half a second before, also if the program is killed.
)";
}

int execute_run(const Arguments& arguments, processes::Signals& signals) {
  const run::Options options = parse_options(arguments, run::by_run);
  if (options.ends_with_input) signals.interrupt_at_end_of(STDIN_FILENO);
  run::SceneStart start(options);
  return run::Run(options, start, run::Service::run, signals).execute();
}

}  // namespace ziggurat::cli
