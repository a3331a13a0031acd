#pragma once
// Where an entity is moved to.

#include <variant>

#include "math/pose.h"
#include "wire/request.h"

namespace ziggurat::supervision {

/// X_WE that a request to move asks for, or what is wrong with it.
/// @param now  of the entity
std::variant<math::Pose, wire::Fault> pose_of_move(const math::Pose& now,
                                                   const wire::Request& request);

}  // namespace ziggurat::supervision
