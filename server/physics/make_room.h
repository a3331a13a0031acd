#pragma once
// Memory that is taken before anything changes.

#include <cstddef>
#include <vector>

namespace ziggurat::physics {

/// Takes memory for more items, so that push_back() can't throw.
template <class Item>
void make_room(std::vector<Item>& items, std::size_t more) {
  if (items.capacity() - items.size() < more) items.reserve(2 * items.size() + more);
}

}  // namespace ziggurat::physics
