// SPDX-License-Identifier: MIT
#pragma once
// Ends scripts from a signal handler, also in endless loops: when the program is interrupted, and
// when a call runs too many instructions or computes for too long. Signals belong to the process,
// and so does this state; nothing else in this program does.

#include <cstdint>
#include <lua.hpp>
#include <string>

namespace ziggurat::lua {

/// The running script, and each one that is called later, ends with the Lua error "interrupted".
/// May be called from a signal handler. A long library function ends only when it returns.
void interrupt_scripts() noexcept;

bool are_scripts_interrupted() noexcept;

/// Whether the running script ends: interrupted, or after too many instructions or too much time.
bool must_scripts_end() noexcept;

/// For tests: scripts run again.
void allow_scripts() noexcept;

/// Fault of the call that was left (stuck_call.h), `FILE:LINE: string.find computes for more than
/// …`.
std::string where_left();

/// Starts a signal (SIGPROF) that looks at the running call each time that this process has
/// computed for 50 ms. A call that lasts longer counts its instructions from there on: counting all
/// of them would make every script slower. Its file and line are then in the place file, if there
/// is one. The same holds for a library function that computes for half a second; of one that
/// sleeps, only the script's file is there. A call may compute for a limited time, in library
/// functions, Lua and collections of garbage together. Beyond it the call ends when Lua runs next.
/// A call with a limit that runs no instruction for max_in_library is in a library function: it is
/// left (stuck_call.h). If it is one that can't be left, the process ends 1 s later with a message.
void watch_scripts();

/// A call of a script.
struct Calling {
  const char* robot = "";              ///< id, for messages
  const char* script = "";             ///< file, in the place file until a line is known
  lua_State* state = nullptr;          ///< of the script
  std::uint64_t max_instructions = 0;  ///< 0 = any number
  std::uint64_t max_computing = 0;     ///< processor time [s]; 0 = any
  std::uint64_t max_in_library =
      5;  ///< processor time of a function of Lua's library [s], if there is another limit
  std::uint64_t max_seconds = 0;  ///< wall time, of a call that computes; 0 = any
};

/// While it lives, interrupt_scripts() ends the script, and so do too many instructions and too
/// much time. Do not nest.
class Running {
 public:
  explicit Running(const Calling& calling) noexcept;
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

 private:
  lua_State* state_;
};

/// The running call continues in another coroutine.
/// @returns the former one
lua_State* switch_to(lua_State* coroutine) noexcept;

}  // namespace ziggurat::lua
