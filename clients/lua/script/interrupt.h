#pragma once
// How a signal handler ends scripts, endless loops included. Signals belong to the process, hence
// the only state of this program that does.

#include <lua.hpp>

namespace ziggurat::lua {

/// The script that runs now, and each that is called later, ends with the Lua error
/// "interrupted". May be called from a signal handler. A coroutine, or a library function that
/// takes its time, is not ended before it comes back.
void interrupt_scripts() noexcept;

bool are_scripts_interrupted() noexcept;

/// For tests: from now on scripts run again.
void allow_scripts() noexcept;

/// While it lives, `state` is what interrupt_scripts() ends. Don't nest.
class Running {
 public:
  explicit Running(lua_State* state) noexcept;
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
};

}  // namespace ziggurat::lua
