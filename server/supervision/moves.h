// SPDX-License-Identifier: MIT
#pragma once
// Entities that are moved, and joints that are set.

#include <optional>
#include <variant>

#include "math/pose.h"
#include "simulation/simulation.h"
#include "supervision/callers.h"
#include "wire/request.h"

namespace ziggurat::supervision {

/// X_WE that a request to move, or to look at a place, asks for, or what is wrong with it.
/// @param now  without an orientation that of this
std::variant<math::Pose, wire::Fault> pose_of(const math::Pose& now, const wire::Request& request);

/// Moves an entity, or sets a joint of it, and tells that it was done, or why it can't be: then
/// nothing has changed.
/// @param entity  into Layout::entities
std::optional<wire::Fault> move(simulation::Simulation& world, const Callers& callers,
                                std::size_t entity, const wire::Request& request);

/// Checks what a request asks of a joint; nothing: it can be set.
/// @param entity  into Layout::entities
std::optional<wire::Fault> check_joint(const simulation::Simulation& world, std::size_t entity,
                                       const wire::Request& request);

}  // namespace ziggurat::supervision
