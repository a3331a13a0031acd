// SPDX-License-Identifier: MIT
#include "script/log_lines.h"

#include <stdexcept>
#include <utility>

namespace ziggurat::lua {
namespace {

template <typename Owner>
bool move_lines(LogLines& from, Owner& to) {
  bool fits = true;
  try {
    for (const LogLine& line : from.lines) {
      line.is_error ? to.log_error(line.text) : to.log(line.text);
    }
  } catch (const std::length_error&) {
    fits = false;
  }
  from.clear();
  return fits;
}

}  // namespace

void LogLines::add(bool is_error, std::string text) {
  if (is_full) return;
  bytes += text.size() + overhead;
  is_full = bytes > max_bytes;
  if (is_full) {
    lines.push_back({true, "logs more than 256 KiB at one tick; the rest of this tick is dropped"});
  } else {
    lines.push_back({is_error, std::move(text)});
  }
}

void LogLines::clear() {
  lines.clear();
  bytes = 0;
  is_full = false;
}

bool move_log(LogLines& from, Robot& to) { return move_lines(from, to); }
bool move_log(LogLines& from, Director& to) { return move_lines(from, to); }

}  // namespace ziggurat::lua
