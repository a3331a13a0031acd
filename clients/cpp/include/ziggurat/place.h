#pragma once
// Where entities are moved to.

namespace ziggurat {

/// What may be at the place that an entity is moved to.
enum class Onto {
  free_place,  ///< nothing: a move onto others is not done
  others,      ///< others, too: what overlaps is pushed apart
};

}  // namespace ziggurat
