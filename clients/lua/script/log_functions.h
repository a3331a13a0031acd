#pragma once
// log() and logerr()

#include <lua.hpp>

#include "script/log_lines.h"

namespace ziggurat::lua {

/// Sets the globals `log` and `logerr`, which add lines to `log`.
void set_log_functions(lua_State* state, LogLines& log);

}  // namespace ziggurat::lua
