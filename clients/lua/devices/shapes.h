// SPDX-License-Identifier: MIT
#pragma once
// Shapes that the dialect gives to devices which describe themselves, where they are not what
// follows from the description.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace ziggurat::lua {

/// A value under another name or in another unit.
struct FieldShape {
  std::string_view field;  ///< of the description
  const char* name;        ///< "a.b": field b of the table a, "a.1": its first element
  double factor = 1;
};

/// A command that a function sets: to a constant, plus a multiple of an argument.
struct SetCommand {
  const char* command = nullptr;  ///< null: none
  double constant = 0, factor = 0;
  std::size_t argument = 0;  ///< from 0
  bool adds = false;         ///< to what it was set to before
};

/// A function of the device's table.
struct FunctionShape {
  const char* name;
  const char* usage;          ///< as messages show it
  std::size_t arguments = 0;  ///< numbers; more than one may come as an array
  std::array<SetCommand, 10> sets{};
};

struct Shape {
  std::string_view kind;
  const char* name;  ///< robot.<name>
  std::span<const FieldShape> fields = {};
  std::span<const FunctionShape> functions = {};  ///< instead of set_<command>
  /// Rows stand in the first of two tables where this reading is 0, in the second where it is not.
  std::string_view split_by = {};
  std::array<const char*, 2> split_names{};
};

/// Null: the shape that follows from the description.
const Shape* find_shape(std::string_view kind);

}  // namespace ziggurat::lua
