#pragma once
// Asks for memory that is read soon, so that it is in the processor's cache by then. A world of a
// thousand robots is larger than that cache, and each of its robots is read several times a substep.

#include <cstddef>
#include <vector>

namespace ziggurat::dynamics {

inline void fetch(const void* memory, std::size_t bytes) {
  constexpr std::size_t line = 64;  // of the cache [bytes]
  for (std::size_t at = 0; at < bytes; at += line) {
    __builtin_prefetch(static_cast<const char*>(memory) + at);
  }
}

template <class Item>
void fetch(const std::vector<Item>& items) {
  fetch(items.data(), items.size() * sizeof(Item));
}

}  // namespace ziggurat::dynamics
