#pragma once
// Durations as people read them.

#include <string>

namespace ziggurat::text {

/// A time that is left, rounded up: `45 s`, `3 min 20 s` or `2 h 5 min`.
/// @param seconds  0 or more
std::string to_duration(double seconds);

}  // namespace ziggurat::text
