// SPDX-License-Identifier: MIT
#include "devices/described_devices.h"

#include <array>
#include <cstring>
#include <tuple>

#include "devices/shapes.h"
#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

constexpr std::string_view color_unit = "0xRRGGBB";

/// Devices of one kind of a robot.
struct Group {
  std::span<Device> devices;
  const ziggurat::DeviceKind& kind;
  const Shape* shape;

  bool are_numbers() const {
    return kind.readings.size() == 1 && kind.properties.empty() && kind.commands.empty() &&
           !kind.reads_rows;
  }
  /// The device's table is that of the kind.
  bool is_alone() const {
    const bool has_functions = shape != nullptr && !shape->functions.empty();
    return devices.size() == 1 && devices[0].id().empty() &&
           (kind.reads_rows || kind.readings.empty() || has_functions);
  }
  bool is_split() const { return shape != nullptr && !shape->split_by.empty(); }
  const char* name() const { return shape ? shape->name : kind.name.c_str(); }
};

/// Calls visit(group, position) for each kind of devices of a robot, positions from 1.
template <class Visit>
void for_each_group(Robot& robot, Visit visit) {
  lua_Integer position = 0;
  for (std::span<Device> left = robot.devices(); !left.empty();) {
    std::size_t count = 1;
    while (count < left.size() && &left[count].kind() == &left[0].kind()) ++count;
    visit(Group{left.first(count), left[0].kind(), find_shape(left[0].kind().name)}, ++position);
    left = left.subspan(count);
  }
}

void push_value(lua_State* state, const DeviceField& field, double value, double factor) {
  if (field.unit != color_unit) return lua_pushnumber(state, value * factor);
  const auto color = static_cast<lua_Integer>(value >= 0 && value <= 0xFFFFFF ? value : 0);
  lua_createtable(state, 0, 3);
  set_integer(state, "red", color >> 16 & 0xFF);
  set_integer(state, "green", color >> 8 & 0xFF);
  set_integer(state, "blue", color & 0xFF);
}

/// Sets a value in the table on top, or in the table `outer` of it, which is made if it is not
/// there.
/// @param name  "outer.inner", or without outer table
void set_shaped(lua_State* state, const FieldShape& shape, const DeviceField& field, double value) {
  const char* const dot = std::strchr(shape.name, '.');
  if (dot != nullptr) {
    const auto length = static_cast<std::size_t>(dot - shape.name);
    lua_pushlstring(state, shape.name, length);
    if (lua_rawget(state, -2) == LUA_TNIL) {
      lua_pop(state, 1);
      push_vector(state, std::array{0.0, 0.0});
      lua_pushlstring(state, shape.name, length);
      lua_pushvalue(state, -2);
      lua_rawset(state, -4);
    }
  }
  push_value(state, field, value, shape.factor);
  const char* const name = dot == nullptr ? shape.name : dot + 1;
  if (*name >= '1' && *name <= '9') {
    lua_rawseti(state, -2, *name - '0');
  } else {
    lua_setfield(state, -2, name);
  }
  if (dot != nullptr) lua_pop(state, 1);
}

/// Sets the values of a device's fields in the table on top.
void set_fields(lua_State* state, const Group& group, const std::vector<DeviceField>& fields,
                std::span<const double> values) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const DeviceField& field = fields[i];
    if (group.is_split() && field.name == group.shape->split_by) continue;
    const FieldShape* as = nullptr;
    if (group.shape != nullptr) {
      for (const FieldShape& shaped : group.shape->fields) {
        if (shaped.field == field.name) as = &shaped;
      }
    }
    if (as != nullptr) {
      set_shaped(state, *as, field, values[i]);
    } else {
      push_value(state, field, values[i], 1);
      lua_setfield(state, -2, field.name.c_str());
    }
  }
}

int set_command(lua_State* state) {
  auto& command = upvalue<const DeviceCommand>(state, 2);
  check_count(state, 1, 1, "set_…(value)");
  upvalue<Device>(state).set(command.name, check_number(state, 1));
  return 0;
}

/// Takes a function's arguments: numbers, or an array of as many.
void check_numbers(lua_State* state, const FunctionShape& function, std::span<double> to) {
  const int count = static_cast<int>(function.arguments);
  if (count > 1 && lua_gettop(state) == 1 && lua_istable(state, 1)) {
    for (int i = 1; i <= count; ++i) lua_geti(state, 1, i);
    lua_remove(state, 1);
  }
  check_count(state, count, count, function.usage);
  for (int i = 0; i < count; ++i) to[static_cast<std::size_t>(i)] = check_number(state, i + 1);
}

int call_shaped(lua_State* state) {
  const auto& function = upvalue<const FunctionShape>(state, 2);
  std::array<double, std::tuple_size_v<decltype(function.sets)>> arguments{};
  check_numbers(state, function, arguments);
  auto& device = upvalue<Device>(state);
  for (const SetCommand& set : function.sets) {
    if (set.command == nullptr) continue;
    const double before = set.adds ? device.commanded(set.command) : 0;
    device.set(set.command, before + set.constant + set.factor * arguments[set.argument]);
  }
  return 0;
}

template <int (*body)(lua_State*), class Subject>
void push_closure(lua_State* state, Device& device, const Subject& subject) {
  lua_pushlightuserdata(state, &device);
  lua_pushlightuserdata(state, const_cast<Subject*>(&subject));
  lua_pushcclosure(state, guarded<body>, 2);
}

/// Sets the functions of a device in the table on top.
void set_functions(lua_State* state, const Group& group, Device& device) {
  if (group.kind.commands.empty()) return;
  if (group.shape != nullptr && !group.shape->functions.empty()) {
    for (const FunctionShape& function : group.shape->functions) {
      push_closure<call_shaped>(state, device, function);
      lua_setfield(state, -2, function.name);
    }
    return;
  }
  for (const DeviceCommand& command : group.kind.commands) {
    lua_pushfstring(state, "set_%s", command.name.c_str());
    push_closure<set_command>(state, device, command);
    lua_rawset(state, -3);
  }
}

/// Sets element `position`, or the device's id, of a table to the value on top, and pops it.
void set_device(lua_State* state, int table, const Device& device, lua_Integer position) {
  if (device.id().empty()) return lua_rawseti(state, table, position);
  set_element(state, table, device.id());
}

/// Pushes the table of a device without readings; @param array  absolute index of what fill gets
void push_device(lua_State* state, const Group& group, Device& device, int array) {
  const auto add_to_fill = [&] {
    lua_pushvalue(state, -1);
    lua_rawseti(state, array, static_cast<lua_Integer>(lua_rawlen(state, array)) + 1);
  };
  lua_newtable(state);
  set_fields(state, group, group.kind.properties, device.properties());
  if (!group.is_split()) add_to_fill();
  for (const char* name :
       group.is_split() ? group.shape->split_names : decltype(Shape::split_names){}) {
    if (name == nullptr) continue;
    lua_newtable(state);
    add_to_fill();
    lua_setfield(state, -2, name);
  }
  set_functions(state, group, device);
}

/// Pushes the table of a kind, then what fill_group() gets: the same if its elements are numbers.
void make_group(lua_State* state, const Group& group) {
  if (group.are_numbers()) {
    lua_newtable(state);
    return lua_pushvalue(state, -1);
  }
  lua_newtable(state);
  const int array = lua_gettop(state);
  if (group.is_alone()) {
    push_device(state, group, group.devices[0], array);
  } else {
    lua_createtable(state, static_cast<int>(group.devices.size()), 0);
    lua_Integer position = 0;
    for (Device& device : group.devices) {
      push_device(state, group, device, array);
      set_device(state, -2, device, ++position);
    }
  }
  lua_insert(state, array);
}

/// Replaces the elements of the array on top by the device's rows.
/// @param is_second  of a split kind: only those that belong into its second table
void fill_rows(lua_State* state, const Group& group, const Device& device, bool is_second) {
  const std::vector<DeviceField>& readings = group.kind.readings;
  std::size_t split = 0;
  while (group.is_split() && split < readings.size() &&
         readings[split].name != group.shape->split_by) {
    ++split;
  }
  lua_Integer position = 0;
  for (std::size_t i = 0; i < device.row_count(); ++i) {
    const std::span<const double> row = device.row(i);
    const bool belongs_second = split < row.size() && row[split] != 0;
    if (group.is_split() && belongs_second != is_second) continue;
    lua_newtable(state);
    set_fields(state, group, group.kind.readings, row);
    lua_rawseti(state, -2, ++position);
  }
  for (auto left = static_cast<lua_Integer>(lua_rawlen(state, -1)); left > position; --left) {
    lua_pushnil(state);
    lua_rawseti(state, -2, left);
  }
}

/// Writes the readings of a kind into what is on top.
void fill_group(lua_State* state, const Group& group) {
  lua_Integer position = 0;
  for (const Device& device : group.devices) {
    if (group.are_numbers()) {
      lua_pushnumber(state, device.readings()[0]);
      set_device(state, -2, device, ++position);
      continue;
    }
    for (int table = 0; table < (group.is_split() ? 2 : 1); ++table) {
      lua_rawgeti(state, -1, ++position);
      if (group.kind.reads_rows) {
        fill_rows(state, group, device, table == 1);
      } else {
        set_fields(state, group, group.kind.readings, device.readings());
      }
      lua_pop(state, 1);
    }
  }
}

}  // namespace

void make_described(lua_State* state, Robot& robot) {
  lua_newtable(state);
  for_each_group(robot, [&](const Group& group, lua_Integer position) {
    luaL_checkstack(state, 16, nullptr);
    make_group(state, group);
    fill_group(state, group);
    lua_rawseti(state, -3, position);
    lua_setfield(state, -3, group.name());
  });
}

void fill_described(lua_State* state, Robot& robot) {
  for_each_group(robot, [&](const Group& group, lua_Integer position) {
    lua_rawgeti(state, -1, position);
    fill_group(state, group);
    lua_pop(state, 1);
  });
}

}  // namespace ziggurat::lua
