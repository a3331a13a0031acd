#include <sstream>

#include "cli/commands.h"
#include "cli/options.h"
#include "run/execution.h"

namespace ziggurat::cli {

std::string help_serve() {
  std::ostringstream text;
  text << R"(usage: ziggurat serve SCENE [OPTION]...

Runs a scene for controllers that connect from outside, Lua controllers included. It waits for them
for ever, says for whom, and ends after the scene's length.

  ziggurat serve vehicle.argos
      listens on tcp://127.0.0.1:5770, and prints that
  ziggurat serve vehicle.argos --endpoint 'tcp://127.0.0.1:*' --json
      listens on any free port; the first line of stdout is {"endpoint":"tcp://127.0.0.1:40123",…}
  ziggurat serve vehicle.argos --endpoint ipc:///tmp/vehicle
      for controllers on this machine
  ziggurat-lua --connect tcp://127.0.0.1:5770
      in another terminal: the scene's Lua controllers
  ziggurat serve stacking.argos --real-time
      a scene without controllers stays paused unless it is paced

  ziggurat serve vehicle.argos --endpoint tcp://0.0.0.0:5770 \
                --curve-secret server.secret --curve-clients clients.txt
      for controllers on other machines whose keys are listed; 'ziggurat help keygen' tells more
  ziggurat serve vehicle.argos --deadline hold:50:100 --lease 30
      a controller that is late by 50 ms is not waited for, and dropped after 100 ticks in a row;
      one whose connection is gone may take up its session within 30 s

A tcp address that isn't loopback is refused without keys or --insecure: whoever reaches it drives
robots.

Exit codes: 0 finished; 1 fault of scene, arguments or environment; 3 a controller failed; 130
interrupted.

)" << serve_options();
  return text.str();
}

int execute_serve(const Arguments& arguments) {
  return execute(parse_options(arguments, serve_options()), run::Service::serve);
}

}  // namespace ziggurat::cli
