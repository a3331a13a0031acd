// SPDX-License-Identifier: MIT
#pragma once
// log() and logerr()

#include <lua.hpp>

#include "script/log_lines.h"

namespace ziggurat::lua {

/// Sets fields `log` and `logerr` of the table on top, which add lines to `log`; that must outlive
/// the state.
void set_log_functions(lua_State* state, LogLines& log);

}  // namespace ziggurat::lua
