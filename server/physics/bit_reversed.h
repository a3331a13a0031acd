#pragma once
// An order in which things in a row make a balanced tree of boxes.

#include <bit>
#include <cstddef>

namespace ziggurat::physics {

/// Calls visit(i) once for each i below count, in the order of their numbers with the bits reversed. Bullet's trees
/// of boxes put each new box where it fits best: in a row, one after another, they make a list.
template <class Visit>
void in_bit_reversed_order(std::size_t count, Visit visit) {
  const std::size_t places = std::bit_ceil(count);
  for (std::size_t i = 0, at = 0; i < places && count > 0; ++i) {
    if (at < count) visit(at);
    std::size_t bit = places / 2;
    for (; (at & bit) != 0; bit /= 2) at ^= bit;
    at |= bit;
  }
}

}  // namespace ziggurat::physics
