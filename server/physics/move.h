#pragma once
// Puts a body somewhere else, as if it had been placed there, and wakes those that it leaves.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include "physics/bodies.h"

namespace ziggurat::physics {

/// At rest, joints as assembled, magnets as at the start; nothing remembers what it touched.
/// @param pose  X_WE of the entity's origin
void move(Body& body, const math::Pose& pose, btDynamicsWorld& world);

/// What sleeps beside the object, or on it, looks again whether it stands.
void wake_neighbours(const btCollisionObject& object, btDynamicsWorld& world);

}  // namespace ziggurat::physics
