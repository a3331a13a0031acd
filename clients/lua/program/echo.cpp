// SPDX-License-Identifier: MIT
#include "program/echo.h"

#include <cstdio>

#include "text/printable.h"

namespace ziggurat::lua {

void echo(const LogLines& log, std::uint64_t tick, const std::string& whose) {
  for (const LogLine& line : log.lines) {
    std::FILE* const to = line.is_error ? stderr : stdout;
    std::fprintf(to, "[%llu %s] ", static_cast<unsigned long long>(tick),
                 text::printable(whose).c_str());
    std::fprintf(to, "%s\n", text::printable(line.text).c_str());
  }
}

void report_lost_log(std::uint64_t tick) {
  std::fprintf(stderr, "ziggurat-lua: tick %llu: more log lines than a message can hold; dropped\n",
               static_cast<unsigned long long>(tick));
}

}  // namespace ziggurat::lua
