// SPDX-License-Identifier: MIT
#pragma once
// Controllers that are given a recorded run again: they see what robots saw then, what they answer
// is compared with the recorded commands and has no effect. `ziggurat verify --controllers` and
// `ziggurat try`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/private_folder.h"
#include "processes/signals.h"
#include "recording/replay/recording_file.h"
#include "reports/console.h"
#include "rerun/controller_replay.h"
#include "run/watch.h"
#include "supervision/supervision.h"
#include "supervision/world.h"

namespace ziggurat::rerun {

struct ControllerCheckOptions {
  std::string recording;  ///< path
  bool quiet = false;
  std::vector<std::pair<std::string, std::string>> controllers;  ///< id, command of the user
  bool trusts_commands = false;            ///< those of the recording may be started
  std::vector<std::string> lua_arguments;  ///< for ziggurat-lua
  std::optional<std::string> robot;        ///< only this one
  std::string command;                     ///< with `robot`: of its controller
  std::string script;                      ///< with `robot`: its Lua script instead
  std::optional<std::uint64_t> until;      ///< the last tick
  std::size_t most_told = 1;               ///< differences that are printed
};

class ControllerCheck {
 public:
  /// Starts the controllers. @throws replay::RecordingError and what main() turns into a message
  ControllerCheck(const ControllerCheckOptions& options, processes::Signals& signals);

  /// Prints the verdict. @returns an exit code
  int execute();

 private:
  using Ending = reports::Ending;

  supervision::World build_world();
  std::size_t tried_controller(const scene::Scene& scene) const;
  std::vector<std::string> embed_scripts();
  network::Config config() const;
  processes::Controllers start();
  std::vector<std::size_t> robots_without_controller() const;
  bool is_checked(std::size_t robot) const;

  std::optional<Ending> repeat();
  int tell(const std::optional<Ending>& ending);

  const ControllerCheckOptions& options_;
  processes::Signals& signals_;
  reports::Console console_;
  const replay::RecordingFile file_;
  const processes::PrivateFolder folder_;
  supervision::World world_;
  std::vector<std::string> scripts_;  ///< per robot at tick 0
  std::vector<bool> gone_;            ///< robots that no controller has
  network::Server server_;
  processes::Controllers controllers_;
  supervision::Callers callers_;
  supervision::Population population_;
  supervision::Supervision supervision_;
  run::Watch watch_;
  std::optional<ControllerReplay> controller_replay_;
  std::size_t told_ = 0;
};

}  // namespace ziggurat::rerun
