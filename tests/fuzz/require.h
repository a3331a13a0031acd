// SPDX-License-Identifier: MIT
#pragma once
// The check that fuzzers use for what must hold.

#include <cstdio>
#include <cstdlib>

namespace ziggurat::fuzz {

/// Unless the condition holds, prints file and line of the call and aborts.
inline void require(bool condition, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: a condition does not hold\n", file, line);
  std::abort();
}

}  // namespace ziggurat::fuzz
