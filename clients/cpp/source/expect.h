#pragma once
// An observation holds what was announced.

#include <cstddef>
#include <stdexcept>
#include <string>

namespace ziggurat {

/// @throws std::runtime_error naming both numbers
inline void expect(std::size_t got, std::size_t announced, const char* what) {
  if (got == announced) return;
  throw std::runtime_error("the server sent " + std::to_string(got) + " " + what +
                           "; it had announced " + std::to_string(announced));
}

}  // namespace ziggurat
