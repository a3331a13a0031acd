// SPDX-License-Identifier: MIT
#pragma once
// Limits of the number of contacts of a world: beyond them a substep would take minutes, and all
// memory.

#include <cstddef>
#include <stdexcept>

namespace ziggurat::physics {

/// Pairs of bodies that are near each other, and points at which bodies touch, each in one substep.
inline constexpr std::size_t most_near_pairs = 1'000'000;
inline constexpr std::size_t most_contact_points = 1'000'000;

class TooManyContacts : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws TooManyContacts
inline void check_near_pairs(std::size_t count) {
  if (count <= most_near_pairs) return;
  throw TooManyContacts(
      "more than 1000000 pairs of bodies are near each other; place fewer bodies in one place");
}

/// @throws TooManyContacts
inline void check_contact_points(std::size_t count) {
  if (count <= most_contact_points) return;
  throw TooManyContacts(
      "bodies touch at more than 1000000 points; place fewer bodies, or farther from each other");
}

}  // namespace ziggurat::physics
