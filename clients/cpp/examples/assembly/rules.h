#pragma once
// The rule table of a structure, from the file that the Lua scripts read, too:
// scenes/construction/rules_*.lua.

#include <ziggurat/ziggurat.h>

#include <cstdint>
#include <string>
#include <vector>

namespace assembly {

/// What the colour of a column's side says. Which columns show it is the blocks' concern.
struct Row {
  std::uint8_t index = 0;  ///< its place in the table, from 1; 0: of no table
  int height = 0;          ///< blocks of the column that shows it
  ziggurat::Color shows;
  bool above = false;       ///< a block is attached above the column; otherwise before the side
  std::string becomes;      ///< state of the attached block
  std::uint8_t number = 0;  ///< of that state, as robots tell it to the block
};

struct Plan {
  std::vector<Row> rows;

  /// The row that a colour shows; null if nothing may be attached there.
  const Row* row_shown(ziggurat::Color color) const;
};

/// @param path  of a Lua file that returns the table. It gets no libraries and a limited time.
/// @throws std::runtime_error that names the file, the row and what is wrong
Plan read_plan(const std::string& path);

}  // namespace assembly
