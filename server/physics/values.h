#pragma once
// Small values that World and its core give and take.

#include <cstddef>

#include "math/pose.h"

namespace ziggurat::physics {

/// A joint with a coordinate, as the world counts them.
struct JointIndex {
  std::size_t value = 0;
};

/// How a link was touched since it was asked last.
struct LinkTouch {
  bool touched = false;                           ///< in a substep at least
  math::Vector3 impulse = math::Vector3::Zero();  ///< the sum on the link, in W [N s]
  double magnitude = 0;  ///< of each contact and substep, their sum [N s]: where contacts press
                         ///< against each other, `impulse` is less
};

}  // namespace ziggurat::physics
