// SPDX-License-Identifier: MIT
#pragma once
// Names everything: the positions that flat arrays are indexed by.

#include <vector>

#include "devices/devices.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::simulation {

/// Appends an entity behind all others.
/// @param substep  [s]
void append(const scene::Scene& scene, const scene::Entity& entity, const devices::Devices& devices,
            double substep, world::Layout& layout);

/// @param entities  all of them, placed, in scene order
/// @param substep   [s]
world::Layout make_layout(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                          double substep);

}  // namespace ziggurat::simulation
