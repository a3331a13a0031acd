#pragma once
// What a fuzzer expects of every input.

#include <cstdio>
#include <cstdlib>

namespace ziggurat::fuzz {

/// Ends the program, and says which line of which file asked, unless the condition holds.
inline void require(bool condition, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: this does not hold\n", file, line);
  std::abort();
}

}  // namespace ziggurat::fuzz
