#pragma once
// Puts mechanisms somewhere else, and wakes what sleeps beside them.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include "physics/bullet/mechanism.h"

namespace ziggurat::physics {

/// At rest, joints as assembled; forgets what it touched, and wakes what it leaves.
/// @param base  X_WP of the reference link's part
void move(Mechanism& mechanism, const btTransform& base, btDynamicsWorld& world);

/// Wakes sleepers beside the object, or on it, so that they check again whether they stand.
void wake_neighbours(const btCollisionObject& object, btDynamicsWorld& world);

}  // namespace ziggurat::physics
