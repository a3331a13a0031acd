#pragma once
// Lets a signal handler end scripts, also in endless loops. Signals belong to the process, and so
// does this state; nothing else in this program does.

#include <lua.hpp>

namespace ziggurat::lua {

/// The running script, and each one that is called later, ends with the Lua error "interrupted".
/// May be called from a signal handler. A coroutine or a long library function ends only when it
/// returns.
void interrupt_scripts() noexcept;

bool are_scripts_interrupted() noexcept;

/// For tests: scripts run again.
void allow_scripts() noexcept;

/// While it lives, interrupt_scripts() ends the script of `state`. Do not nest.
class Running {
 public:
  explicit Running(lua_State* state) noexcept;
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
};

}  // namespace ziggurat::lua
