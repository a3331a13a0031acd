#pragma once

#include <LinearMath/btVector3.h>

namespace ziggurat::physics {

/// Twist of a part or a link.
struct Twist {
  btVector3 velocity{0, 0, 0};          ///< of the centre of mass, in the world [m/s]
  btVector3 angular_velocity{0, 0, 0};  ///< in the world [rad/s]
};

}  // namespace ziggurat::physics
