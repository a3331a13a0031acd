// SPDX-License-Identifier: MIT
#pragma once
// Asks for memory that is read soon, so that it is in the processor's cache by then. A world of a
// thousand robots is larger than that cache, and each of its robots is read several times a
// substep.

#include <cstddef>
#include <vector>

namespace ziggurat::dynamics {

inline void prefetch(const void* memory, std::size_t bytes) {
  constexpr std::size_t line = 64;  // of the cache [bytes]
  if (!memory || bytes == 0) return;
  const char* const first = static_cast<const char*>(memory);
  for (std::size_t at = 0; at < bytes; at += line) __builtin_prefetch(first + at);
  __builtin_prefetch(first + bytes - 1);  // it need not begin where a line does
  asm volatile("");  // otherwise GCC leaves out calls of functions that do no more than this
}

template <class Item>
void prefetch(const std::vector<Item>& items) {
  prefetch(items.data(), items.size() * sizeof(Item));
}

}  // namespace ziggurat::dynamics
