// SPDX-License-Identifier: MIT
#pragma once
// Runs the scripts of a session's robots from its first tick to its end.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "program/options.h"
#include "script/arena.h"
#include "script/controller.h"
#include "ziggurat/session.h"

namespace ziggurat::lua {

class Runner {
 public:
  /// @param session  freshly opened; outlives the runner
  /// @throws std::runtime_error if a folder of the options is none
  Runner(ziggurat::Session& session, const ProgramOptions& options);

  /// Until the run is over or a signal interrupts it.
  /// @throws ConnectionError, ProtocolError
  void run();

  bool has_failures() const { return failures_ > 0; }

 private:
  struct Seat {
    ziggurat::Robot* robot = nullptr;
    std::unique_ptr<Controller> controller;  ///< null once it failed, or its robot has left the run
  };

  void start(Seat& seat);
  void answer(Seat& seat);
  void finish();
  void end(Seat& seat);  ///< its robot has left the run
  void destroy(Seat& seat, std::uint64_t max_seconds = 0);
  Failure call(Controller& controller);
  void hand_over_log(Seat& seat);
  /// @param only_here  what stderr tells beside that, and the server is not told
  void fail(Seat& seat, const std::string& message, const std::string& only_here = {});

  ziggurat::Session& session_;
  const ProgramOptions& options_;
  const Folders folders_;
  Arena arena_;              ///< for all seats
  std::vector<Seat> seats_;  ///< as the session's robots
  std::size_t failures_ = 0;
};

}  // namespace ziggurat::lua
