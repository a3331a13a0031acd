#pragma once
// Puts a body somewhere else, as if it had been placed there.

#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include "physics/bodies.h"

namespace ziggurat::physics {

/// At rest, joints as assembled, magnets as at the start; nothing remembers what it touched.
/// @param pose  X_WE of the entity's origin
void move(Body& body, const math::Pose& pose, btDynamicsWorld& world);

}  // namespace ziggurat::physics
