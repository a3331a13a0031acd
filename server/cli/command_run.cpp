#include <sstream>

#include "cli/commands.h"
#include "cli/options.h"
#include "run/execution.h"

namespace ziggurat::cli {

std::string help_run() {
  std::ostringstream text;
  text << R"(usage: ziggurat run SCENE [OPTION]...

Runs a scene: starts its controllers as processes of their own, moves the world tick by tick in
lock-step with them, for the scene's length or, if that is 0, until Ctrl-C.

  ziggurat run vehicle.argos
      as the scene says
  ziggurat run vehicle.argos --duration 10 --trace poses.csv
      ten simulated seconds; where everything stood at every tick goes to poses.csv
  ziggurat run vehicle.argos --seed 7 --hash --quiet
      only controllers' lines and the state's hash: equal seeds give equal hashes
  ziggurat run swarm.argos --lua-processes 2
      Lua robots shared between two processes; 0 is a process for each robot
  ziggurat run vehicle.argos --controller 'drive=./my-controller --verbose'
      a program in place of a controller of the scene; it finds the server in its environment:
      ZIGGURAT_ENDPOINT, and ZIGGURAT_CONTROLLER, the controller's id
  ziggurat run vehicle.argos --endpoint tcp://127.0.0.1:5770
      an <external_controller> without command may connect there from outside

stdout carries the lines that controllers log, as [TICK ROBOT] TEXT, and nothing else but the hash,
last. stderr carries faults, notices, progress (on a terminal) and a summary.

Exit codes: 0 finished; 1 fault of scene, arguments or environment; 3 a controller failed or its
process vanished; 130 interrupted. A second Ctrl-C doesn't wait for controllers.

)" << run_options();
  return text.str();
}

int execute_run(const Arguments& arguments) {
  return execute(parse_options(arguments, run_options()), run::Service::run);
}

}  // namespace ziggurat::cli
