// SPDX-License-Identifier: MIT
#pragma once
// The rule table of a structure, from the file that the Lua scripts read, too:
// scenes/construction/rules_*.lua.

#include <ziggurat/ziggurat.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace assembly {

/// Rule for the colour of a column's side. Sides count from the one that faced the robot that
/// placed the column's lowest block.
struct Row {
  std::uint8_t index = 0;       ///< its place in the table, from 1; 0: of no table
  std::string state;            ///< of the lowest block of the column that shows it
  int height = 0;               ///< of that column [blocks]
  std::array<bool, 4> sides{};  ///< of that column that show it: front, left, back, right
  bool is_everywhere = true;    ///< all of them do
  ziggurat::Color shows;
  bool above = false;       ///< a block is attached above the column; otherwise before the side
  std::string becomes;      ///< state of the attached block
  std::uint8_t number = 0;  ///< of that state, as robots tell it to the block
};

struct Plan {
  std::vector<Row> rows;

  /// The row with this index, from 1; null if there is none.
  const Row* row_of(std::size_t index) const;
  /// The row that a side of a column shows; null if nothing may be attached there.
  /// @param side         from the front, 0 to 3
  /// @param is_occupied  something stands before that side
  const Row* row_for(const std::string& state, int height, int side, bool is_occupied) const;
  /// The row that a colour shows; null if nothing may be attached there.
  const Row* row_shown(ziggurat::Color color) const;
  /// The row by which a block was attached, before a column with this state, whose own column now
  /// shows `row`; null if there is none.
  const Row* origin_of(const Row& row, const std::string& state) const;
};

/// @param path  of a Lua file that returns the table. It gets no libraries and a limited time.
/// @throws std::runtime_error that names the file, the row and what is wrong
Plan read_plan(const std::string& path);

}  // namespace assembly
