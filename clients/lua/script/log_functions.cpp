#include "script/log_functions.h"

#include <charconv>
#include <string>

#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

template <typename... Format>
void append(std::string& text, Format... number_and_format) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number_and_format...).ptr;
  text.append(digits, end);
}

// Raises no Lua error: the memory of `text` would leak.
void append_value(lua_State* state, int index, std::string& text) {
  switch (lua_type(state, index)) {
    case LUA_TBOOLEAN:
      text += lua_toboolean(state, index) ? '1' : '0';
      break;
    case LUA_TNUMBER:
      if (lua_isinteger(state, index)) {
        append(text, lua_tointeger(state, index));
      } else {
        // The format of C++ streams: at most 6 significant digits.
        append(text, lua_tonumber(state, index), std::chars_format::general, 6);
      }
      break;
    case LUA_TSTRING: {
      std::size_t size = 0;
      const char* bytes = lua_tolstring(state, index, &size);
      text.append(bytes, size);
      break;
    }
    default:
      text += luaL_typename(state, index);
  }
}

template <bool is_error>
int add_line(lua_State* state) {
  std::string text;
  for (int i = 1; i <= lua_gettop(state) && text.size() <= LogLines::max_bytes; ++i) {
    append_value(state, i, text);
  }
  upvalue<LogLines>(state).add(is_error, std::move(text));
  return 0;
}

}  // namespace

void set_log_functions(lua_State* state, LogLines& log) {
  set_function<add_line<false>>(state, "log", &log);
  set_function<add_line<true>>(state, "logerr", &log);
}

}  // namespace ziggurat::lua
