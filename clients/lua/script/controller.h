// SPDX-License-Identifier: MIT
#pragma once
// The script of a robot: its life cycle.

#include <cstdint>

#include "script/script.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Runs the script of one robot.
class Controller final : public Script {
 public:
  /// @param robot  outlives the controller and does not move
  /// @throws std::bad_alloc if max_memory does not hold an empty state
  Controller(Robot& robot, const ScriptOptions& options);

  /// At the first tick: creates `robot` and `log`, runs the script's chunk, then init().
  Failure start();
  /// @param tick  >= 1
  Failure step(std::uint64_t tick);
  /// The world was reset to tick 0: restarts the random streams and calls reset(), if the script
  /// has one.
  /// @param seed  of the new run
  Failure reset(std::uint64_t seed);
  /// After the last tick: calls destroy(), if the script has one.
  /// @param max_seconds  as of Calling; 0 = any
  Failure destroy(std::uint64_t last_tick, std::uint64_t max_seconds = 0);

 private:
  void set_up(lua_State* state) override;
  void refresh(lua_State* state) override;

  Robot& robot_;
};

}  // namespace ziggurat::lua
