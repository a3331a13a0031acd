#pragma once
// What a Lua error says, with the traceback of where it was raised.

#include <lua.hpp>
#include <string>

namespace ziggurat::lua {

/// Makes room for tracebacks. May raise a Lua error.
void prepare_error_messages(lua_State* state);

/// The message handler for lua_pcall: turns the error object into a string and keeps the
/// traceback.
int keep_traceback(lua_State* state);

struct ErrorMessage {
  std::string text;
  std::string traceback;  ///< "stack traceback:\n…"; empty if there was no memory for it
};

/// Of the error that lua_pcall left on top; pops it. Long ones are shortened.
ErrorMessage take_error_message(lua_State* state);

}  // namespace ziggurat::lua
