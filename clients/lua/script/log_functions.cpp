// SPDX-License-Identifier: MIT
#include "script/log_functions.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

template <typename... Format>
void append(std::string& text, Format... number_and_format) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number_and_format...).ptr;
  text.append(digits, end);
}

constexpr int deepest_logged = 3;            // tables in tables
constexpr std::size_t most_logged = 100;     // fields of a table
constexpr std::size_t most_sorted = 10'000;  // entries of a table: of more the order is not known
constexpr std::size_t longest = 1000;        // text in a table, and name of a field [bytes]

void append_value(lua_State* state, int index, std::string& text, int depth);

/// The value on top, in a table: a string in quotes.
void append_element(lua_State* state, std::string& text, int depth) {
  if (lua_type(state, -1) != LUA_TSTRING)
    return append_value(state, lua_gettop(state), text, depth);
  std::size_t size = 0;
  const char* bytes = lua_tolstring(state, -1, &size);
  text += '"' + std::string(bytes, std::min(size, longest)) + (size > longest ? "…\"" : "\"");
}

/// Whether the entry on top has a name; valid as long as the table is unchanged.
bool has_name(lua_State* state, std::string_view& name) {
  if (lua_type(state, -2) != LUA_TSTRING) return false;
  std::size_t size = 0;
  const char* bytes = lua_tolstring(state, -2, &size);
  name = {bytes, size};
  return true;
}

struct Field {
  std::string_view name;
  std::string value;
};

/// The first named fields of the table on top, by their bytes.
/// @param elements  that it has besides, from 1 on
/// @param is_all    made false if there is more
std::vector<Field> fields_in(lua_State* state, int depth, std::size_t elements, bool& is_all) {
  std::vector<Field> fields;
  std::string_view name;
  std::size_t read = 0;
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) {
    if (++read > most_sorted) {
      lua_pop(state, 2);
      is_all = false;
      return {};
    }
    if (has_name(state, name)) fields.push_back({name, {}});
  }
  std::ranges::sort(fields, {}, &Field::name);
  is_all = fields.size() <= most_logged && read == fields.size() + elements;
  fields.resize(std::min(fields.size(), most_logged));
  std::size_t size = 0;
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) {
    if (size > LogLines::max_bytes || !has_name(state, name)) continue;
    const auto field = std::ranges::lower_bound(fields, name, {}, &Field::name);
    if (field == fields.end() || field->name != name) continue;
    append_element(state, field->value, depth);
    size += field->value.size();
  }
  return fields;
}

/// {1, 2, x = 3, …}: elements from 1 on, then fields with a name, and whether there is more.
void append_table(lua_State* state, int index, std::string& text, int depth) {
  if (depth == deepest_logged || lua_checkstack(state, 4) == 0) {
    text += "{…}";
    return;
  }
  const std::size_t most = text.size() + LogLines::max_bytes;
  const char* before = "";
  const auto begin = [&] {
    text += before;
    before = ", ";
  };
  text += "{";
  std::size_t elements = 0;
  for (; text.size() <= most &&
         lua_rawgeti(state, index, static_cast<lua_Integer>(elements) + 1) != LUA_TNIL;
       ++elements) {
    begin();
    append_element(state, text, depth + 1);
    lua_pop(state, 1);
  }
  if (text.size() <= most) lua_pop(state, 1);  // the nil behind them
  lua_pushvalue(state, index);
  bool is_all = true;
  for (const Field& field : fields_in(state, depth + 1, elements, is_all)) {
    begin();
    text += std::string(field.name.substr(0, longest)) + " = " + field.value;
  }
  lua_pop(state, 1);
  if (!is_all) begin();
  text += is_all ? "}" : "…}";
}

// Raises no Lua error: the memory of `text` would leak.
void append_value(lua_State* state, int index, std::string& text, int depth) {
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
    case LUA_TTABLE:
      append_table(state, index, text, depth);
      break;
    default:
      text += luaL_typename(state, index);
  }
}

template <bool is_error>
int add_line(lua_State* state) {
  std::string text;
  for (int i = 1; i <= lua_gettop(state) && text.size() <= LogLines::max_bytes; ++i) {
    append_value(state, i, text, 0);
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
