#pragma once
// A place in one of the files of a scene.

#include <compare>
#include <cstddef>

namespace ziggurat::scene {

struct Location {
  std::size_t file = 0;  ///< index into Scene::files
  unsigned line = 0;     ///< from 1; 0 = nowhere in particular
  unsigned column = 0;   ///< from 1
  auto operator<=>(const Location&) const = default;
};

}  // namespace ziggurat::scene
