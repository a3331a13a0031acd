// SPDX-License-Identifier: MIT
#pragma once
// Places in a director's script of acts that the server may refuse later.

#include <lua.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat::lua {

class ActPlaces {
 public:
  /// The next act was asked for by the Lua function that called the running one.
  void add(lua_State* state);
  void clear() { all_.clear(); }

  /// `FILE:LINE: ` for an error's field that begins with `acts[N]`; empty for another.
  std::string before_error_of(std::string_view field) const;

 private:
  struct Place {
    char file[LUA_IDSIZE] = "";
    int line = -1;
  };
  std::vector<Place> all_;
};

}  // namespace ziggurat::lua
