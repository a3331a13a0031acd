// SPDX-License-Identifier: MIT
#pragma once
// Message and traceback of a Lua error.

#include <lua.hpp>
#include <string>

namespace ziggurat::lua {

/// Reserves memory for tracebacks. May raise a Lua error.
void prepare_error_messages(lua_State* state);

/// The message handler for lua_pcall: turns the error object into a string and keeps the
/// traceback.
int keep_traceback(lua_State* state);

struct ErrorMessage {
  std::string text;
  std::string traceback;  ///< "stack traceback:\n…"; empty if there was no memory for it
};

/// Message of the error on top of the stack, from lua_pcall; pops it. Shortens long messages.
ErrorMessage take_error_message(lua_State* state);

}  // namespace ziggurat::lua
