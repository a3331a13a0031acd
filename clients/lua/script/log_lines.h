// SPDX-License-Identifier: MIT
#pragma once
// The log lines of a script at one tick.

#include <cstddef>
#include <string>
#include <vector>

#include "ziggurat/director.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

struct LogLine {
  bool is_error = false;  ///< from logerr()
  std::string text;       ///< any bytes; no line feed at the end
};

/// Log lines of one robot at one tick. Bounded: a script that logs in an endless loop must not use
/// up the memory or block the session's other robots.
struct LogLines {
  static constexpr std::size_t max_bytes = std::size_t{256} << 10;
  static constexpr std::size_t overhead = 64;  ///< of a line, besides its text [bytes]

  std::vector<LogLine> lines;
  std::size_t bytes = 0;
  bool is_full = false;  ///< lines were dropped; the last line reports it

  void add(bool is_error, std::string text);
  void clear();  ///< keeps its memory for the next tick
};

/// Moves the lines to the log of a robot or director. False if the session takes no more of them at
/// this tick; the rest is dropped.
bool move_log(LogLines& from, Robot& to);
bool move_log(LogLines& from, Director& to);

}  // namespace ziggurat::lua
