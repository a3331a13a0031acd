#pragma once

#include <algorithm>

namespace ziggurat::physics::contact {

/// A stable sort for a handful of items. std::stable_sort allocates, each time it is called.
template <class Item, class Less>
void sort_few(Item* first, Item* last, Less less) {
  for (Item* next = first; next != last; ++next) {
    std::rotate(std::upper_bound(first, next, *next, less), next, next + 1);
  }
}

}  // namespace ziggurat::physics::contact
