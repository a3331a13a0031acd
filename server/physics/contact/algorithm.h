#pragma once
// Joins the contact geometry to Bullet: one collision algorithm for every pair of our shapes.

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include <cstddef>
#include <memory>

#include "physics/contact/shapes.h"

namespace ziggurat::physics::contact {

/// Data of a collision object, which has a pointer to it.
struct Collider {
  static constexpr std::size_t floor = static_cast<std::size_t>(-1);
  Shape shape;
  std::size_t entity = floor;     ///< in order of adding
  std::size_t link = 0;           ///< of the entity
  btScalar friction = 0.5;        ///< Coulomb coefficient; two surfaces combine by product
  btScalar rolling_friction = 0;  ///< [m]; two surfaces combine by sum
  bool rolls = false;             ///< has wheels: does not rub on what is below or above it
  btScalar reach = 0;             ///< distance at which contacts are kept, this substep [m]
  btTransform previous = btTransform::getIdentity();  ///< pose one substep ago
};

/// The collider of one of our collision objects.
const Collider& collider_of(const btCollisionObject& object);

/// Bullet's pools with elements large enough for our algorithm; without it the heap is overrun.
btDefaultCollisionConstructionInfo construction_info();

/// Makes our algorithm answer for all pairs of shapes. The returned
/// object must outlive the dispatcher's use of it.
std::unique_ptr<btCollisionAlgorithmCreateFunc> register_algorithms(
    btCollisionDispatcher& dispatcher);

}  // namespace ziggurat::physics::contact
