#pragma once
// Places that entities are moved to.

namespace ziggurat {

/// Occupants that the place of a moved entity may have.
enum class Onto {
  free_place,  ///< nothing: a move onto others is not done
  others,      ///< others, too: what overlaps is pushed apart
};

}  // namespace ziggurat
