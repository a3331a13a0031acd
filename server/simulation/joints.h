// SPDX-License-Identifier: MIT
#pragma once
// Joints that are put to a position and a speed from outside.

#include <cstddef>
#include <optional>
#include <string>

#include "simulation/simulation.h"

namespace ziggurat::simulation {

/// A joint of an entity, and the motion that it shall have.
struct JointMotion {
  std::string joint;    ///< id
  double position = 0;  ///< from the assembled pose [m] or [rad]
  double velocity = 0;  ///< [m/s] or [rad/s]
};

/// Why a joint can't have a motion.
struct JointFault {
  enum class Of { joint, position, velocity };
  Of of = Of::joint;  ///< the part that is wrong
  std::string text;   ///< one sentence, which says what is allowed
};

/// Checks a motion; nothing: it can be set.
/// @param entity  into Layout::entities, one that is present
std::optional<JointFault> fault_of(const Simulation& world, std::size_t entity,
                                   const JointMotion& wanted);

/// Puts a joint to a position and a speed: what hangs on it follows, other joints and the root of
/// the entity stay as they are, and motors keep their targets. It is sensed at the next tick.
/// @pre fault_of() finds nothing
void set_joint(Simulation& to, std::size_t entity, const JointMotion& wanted);

}  // namespace ziggurat::simulation
