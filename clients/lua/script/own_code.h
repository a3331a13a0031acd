// SPDX-License-Identifier: MIT
#pragma once
// Functions of each script's state that are written in Lua.

#include <lua.hpp>
#include <string>
#include <string_view>

namespace ziggurat::lua {

/// A chunk that is compiled once for all states. It has no lines and no names of local variables:
/// they take as much of each robot's state as the code.
class OwnCode {
 public:
  /// @param source  without faults
  /// @param name    in messages, for example "=pairs"; stays
  OwnCode(std::string_view source, const char* name) noexcept;
  /// Pushes the chunk.
  void push(lua_State* state) const;

 private:
  std::string bytes_;
  const char* name_;
};

}  // namespace ziggurat::lua
