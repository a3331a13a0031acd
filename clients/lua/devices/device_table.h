#pragma once
// The kinds of devices that a script finds below `robot`, one file each in this folder.
//
// A new kind is a short walk: its values in script/scripted_robot.h, its file here, a row in
// device_table.cpp, its lines in program/exchange.cpp, its section in docs/lua-api.md.

#include <lua.hpp>
#include <span>

#include "script/scripted_robot.h"

namespace ziggurat::lua {

/// One kind of device. Tables are made once and written in place at every tick: scripts may keep
/// them and their functions, and nothing is allocated.
struct DeviceKind {
  const char* name;                          ///< robot.<name>
  bool (*is_present)(const ScriptedRobot&);  ///< the robot has devices of this kind

  /// Pushes robot.<name>, as refresh() will find it even if the script puts something else there.
  /// The robot outlives the state and does not move.
  void (*push)(lua_State*, ScriptedRobot&);

  /// Writes what was sensed into the tables; leaves the stack as it was.
  void (*refresh)(lua_State*, const ScriptedRobot&);
};

/// All kinds there are.
std::span<const DeviceKind> device_kinds();

}  // namespace ziggurat::lua
