#pragma once
// Contacts of Bullet's manifolds in the last substep, for plug-ins.

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <vector>

#include "physics/plugin.h"

namespace ziggurat::physics {

/// @param out  emptied before; in ascending order of its sides
void collect(btDispatcher& dispatcher, std::vector<LinkContact>& out);

}  // namespace ziggurat::physics
