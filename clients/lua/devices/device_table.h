// SPDX-License-Identifier: MIT
#pragma once
// The kinds of devices that a script finds below `robot`, one file each in this folder.
//
// A new kind is a file here, a line in device_table.cpp, and a section in docs/lua-api.md.

#include <lua.hpp>
#include <span>

#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// One kind of device. Tables are made once and filled in place at every tick: scripts may keep
/// them and their functions, and numbers allocate nothing.
struct DeviceKind {
  const char* name;            ///< robot.<name>
  bool (*is_present)(Robot&);  ///< the robot has devices of this kind
  /// Pushes robot.<name> without readings. May push a second value, for fill(). The robot outlives
  /// the state and does not move.
  void (*make)(lua_State*, Robot&);
  /// Writes the readings into the value on top, which make() pushed last: it is the same even if
  /// the script sets robot.<name> to something else. Null if there are no readings.
  void (*fill)(lua_State*, Robot&);
};

/// All kinds.
std::span<const DeviceKind* const> device_kinds();

}  // namespace ziggurat::lua
