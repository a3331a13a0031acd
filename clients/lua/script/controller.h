#pragma once
// The script of a robot: its Lua state and its life cycle.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "script/environment.h"
#include "script/folders.h"
#include "script/interrupt.h"
#include "script/log_lines.h"
#include "script/memory.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

struct ControllerOptions {
  std::filesystem::path script;
  std::uint64_t seed = 1;                           ///< of the run
  std::uint64_t first_tick = 0;                     ///< at which the script begins: `robot.first_tick`
  std::size_t max_memory = std::size_t{256} << 20;  ///< of the script's Lua state [bytes]
  std::uint64_t max_instructions = 1'000'000'000;   ///< of a call (interrupt.h); 0 = any number
  /// The files that the script may use; they outlive it. Null: the script is trusted, and may use
  /// all of Lua.
  const Folders* folders = nullptr;
};

/// The error of a script: `scenes/x.lua:12: attempt to … (in step 37)`, a line feed, and Lua's
/// traceback. Do not call the script again.
using Failure = std::optional<std::string>;

/// Runs the script of one robot. Every error of the script is a Failure, never an exception.
class Controller {
 public:
  /// @param robot  outlives the controller and does not move
  /// @throws std::bad_alloc if max_memory does not hold an empty state
  Controller(Robot& robot, const ControllerOptions& options);
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// What the script logged, also in a call that failed. The caller clears it.
  LogLines& log() { return log_; }

  /// At the first tick: creates `robot` and `log`, runs the script's chunk, then init().
  Failure start();
  /// @param tick  >= 1
  Failure step(std::uint64_t tick);
  /// The world was reset to tick 0: restarts the random streams and calls reset(), if the script
  /// has one.
  /// @param seed  of the new run
  Failure reset(std::uint64_t seed);
  /// After the last tick: calls destroy(), if the script has one.
  Failure destroy(std::uint64_t last_tick);

  std::size_t used_memory() const { return state_.used_bytes(); }  ///< [bytes]

 private:
  struct Wanted {
    const char* name = nullptr;  // of a function of the script
    bool is_required = false;
  };
  static int build(lua_State* state);
  static int load(lua_State* state);
  static int prepare(lua_State* state);

  Failure run_chunk();
  Failure call(const char* function, bool is_required, const std::string& moment);
  Failure call_prepared(const std::string& moment);
  void push_protected(int (*function)(lua_State*));
  Calling calling() const { return {robot_.id().c_str(), script_.c_str(), state_.get(), max_instructions_}; }
  std::string describe_error(const std::string& moment);

  Robot& robot_;
  LogLines log_;
  RandomStreams random_;
  std::uint64_t first_tick_;
  std::size_t max_memory_;
  std::uint64_t max_instructions_;
  const Folders* folders_;
  std::string script_;  // path for messages
  std::string folder_;  // of the script
  Wanted wanted_;       // by prepare()
  BoundedState state_;  // last: its finalizers may use the others
};

}  // namespace ziggurat::lua
