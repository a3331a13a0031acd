#include "physics/floor.h"

namespace ziggurat::physics {

Floor::Floor(const scene::Floor& floor, btMultiBodyDynamicsWorld& world)
    : world_(world),
      plane_(btVector3(0, 0, 1), 0),
      body_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane_)) {
  collider_.shape = contact::HalfSpace{};
  collider_.friction = floor.surface.friction;
  collider_.rolling_friction = floor.surface.rolling_friction;
  body_.setUserPointer(&collider_);
  world_.addRigidBody(&body_);
}

Floor::~Floor() { world_.removeRigidBody(&body_); }

}  // namespace ziggurat::physics
