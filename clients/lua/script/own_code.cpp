// SPDX-License-Identifier: MIT
#include "script/own_code.h"

#include <cstddef>

namespace ziggurat::lua {
namespace {

int append(lua_State* state, const void* bytes, std::size_t size, void* text) {
  (void)state;
  static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), size);
  return 0;
}

}  // namespace

OwnCode::OwnCode(std::string_view source, const char* name) noexcept : name_(name) {
  constexpr int without_lines = 1;
  lua_State* const state = luaL_newstate();
  if (state == nullptr) return;  // push() tells it
  if (luaL_loadbufferx(state, source.data(), source.size(), name, "t") == LUA_OK)
    lua_dump(state, append, &bytes_, without_lines);
  lua_close(state);
}

void OwnCode::push(lua_State* state) const {
  if (luaL_loadbufferx(state, bytes_.data(), bytes_.size(), name_, "b") != LUA_OK) lua_error(state);
}

}  // namespace ziggurat::lua
