// SPDX-License-Identifier: MIT
#include <unistd.h>

#include "cli/commands.h"
#include "cli/options.h"
#include "run/run.h"

namespace ziggurat::cli {

std::string help_serve() {
  return R"(usage: ziggurat serve SCENE [OPTION]...

Runs a scene for controllers that connect from outside, also Lua controllers. The server waits for
them forever, prints which robots it waits for, and ends after the scene's length. Directors of the scene
that have a script or a command are started as by 'ziggurat run'; --without-directors starts none.

  ziggurat serve vehicle.argos
      listens on a socket in $XDG_RUNTIME_DIR/ziggurat, otherwise in /tmp/ziggurat-UID, that only this user
      can reach, and prints where
  ziggurat serve vehicle.argos --endpoint 'tcp://127.0.0.1:*' --json
      listens on any free port; the first line of stdout is {"endpoint":"tcp://127.0.0.1:40123",…}
  ziggurat serve vehicle.argos --endpoint ipc:///tmp/vehicle
      for controllers on this machine
  ziggurat-lua
      in another terminal: the scene's Lua controllers
  ziggurat serve vehicle.argos --endpoint tcp://127.0.0.1:5770
      for all users of this machine
  ziggurat serve stacking.argos --real-time
      without --real-time a scene without controllers starts paused

  ziggurat serve vehicle.argos --endpoint tcp://0.0.0.0:5770 \
                --curve-secret server.secret --curve-clients clients.txt
      for controllers on other machines whose keys are listed; see 'ziggurat help keygen'
  ziggurat serve vehicle.argos --deadline hold:50:100 --lease 30
      a controller that has not answered after 50 ms holds its last command, and is dropped after
      100 misses in a row; a disconnected one may take its robots back within 30 s

A tcp address that is not loopback needs keys or --insecure, because every program that can connect
controls robots.

Exit codes: 0 finished; 1 fault of scene, arguments or environment; 3 a controller failed, or a
deadline dropped a robot; 4 the gate was missed; 130 interrupted.
)";
}

int execute_serve(const Arguments& arguments, processes::Signals& signals) {
  const run::Options options = parse_options(arguments, run::by_serve);
  if (options.ends_with_input) signals.interrupt_at_end_of(STDIN_FILENO);
  run::SceneStart start(options);
  return run::Run(options, start, run::Service::serve, signals).execute();
}

}  // namespace ziggurat::cli
