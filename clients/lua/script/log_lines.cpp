#include "script/log_lines.h"

#include <utility>

namespace ziggurat::lua {

void LogLines::add(bool is_error, std::string text) {
  if (is_full) return;
  bytes += text.size() + overhead;
  is_full = bytes > max_bytes;
  if (is_full) {
    lines.push_back({true, "logs more than 1 MiB at one tick; the rest of this tick is dropped"});
  } else {
    lines.push_back({is_error, std::move(text)});
  }
}

void LogLines::clear() {
  lines.clear();
  bytes = 0;
  is_full = false;
}

}  // namespace ziggurat::lua
