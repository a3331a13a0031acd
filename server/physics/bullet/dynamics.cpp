#include "physics/bullet/dynamics.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "physics/contact/algorithm.h"
#include "physics/contact_limits.h"

namespace ziggurat::physics {
namespace {

/// Bound of the speed of a body's surface [m/s], from its last displacement for links of
/// multi-bodies.
btScalar surface_speed(const btCollisionObject& object, const contact::Collider& collider,
                       btScalar length) {
  btVector3 centre;
  btScalar radius;
  object.getCollisionShape()->getBoundingSphere(centre, radius);
  if (const btRigidBody* rigid = btRigidBody::upcast(&object)) {
    return rigid->getLinearVelocity().length() + rigid->getAngularVelocity().length() * radius;
  }
  const btTransform& now = object.getWorldTransform();
  const btScalar moved = (now.getOrigin() - collider.previous.getOrigin()).length();
  btScalar turned = 0;
  for (int i = 0; i < 3; ++i) {
    turned = btMax(
        turned, (now.getBasis().getColumn(i) - collider.previous.getBasis().getColumn(i)).length());
  }
  return (moved + turned * radius) / length;
}

constexpr btScalar box_slack = 1e-3;  // how much larger than needed a new box is made [m]

}  // namespace

Dynamics::Dynamics(btDispatcher& dispatcher, btDbvtBroadphase& broadphase,
                   btMultiBodyConstraintSolver& solver, btCollisionConfiguration& configuration)
    : btMultiBodyDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration),
      broadphase_(broadphase) {}

/// Bullet's boxes only grow: a body that fell fast would keep a large one, and a neighbour in
/// each pair it makes, forever. Ours are renewed when too small or much too large.
void Dynamics::keep_in_box(btBroadphaseProxy& proxy, const btVector3& low, const btVector3& high) {
  const btVector3 slack(box_slack, box_slack, box_slack);
  const auto inside = [](const btVector3& outer_low, const btVector3& outer_high,
                         const btVector3& inner_low, const btVector3& inner_high) {
    return outer_low.x() <= inner_low.x() && outer_low.y() <= inner_low.y() &&
           outer_low.z() <= inner_low.z() && outer_high.x() >= inner_high.x() &&
           outer_high.y() >= inner_high.y() && outer_high.z() >= inner_high.z();
  };
  const bool large_enough = inside(proxy.m_aabbMin, proxy.m_aabbMax, low, high);
  const bool small_enough =
      inside(low - 3 * slack, high + 3 * slack, proxy.m_aabbMin, proxy.m_aabbMax);
  if (large_enough && small_enough) return;
  broadphase_.setAabbForceUpdate(&proxy, low - slack, high + slack, m_dispatcher1);
  check_near_pairs(static_cast<std::size_t>(
      getBroadphase()->getOverlappingPairCache()->getNumOverlappingPairs()));
}

void Dynamics::substep(btScalar length) {
  length_ = length;
  getSolverInfo().m_timeStep = length;
  getDispatchInfo().m_timeStep = length;
  internalSingleStepSimulation(length);
  clearForces();
}

void Dynamics::addCollisionObject(btCollisionObject* object, int group, int mask) {
  btMultiBodyDynamicsWorld::addCollisionObject(object, group, mask);
  btMultiBodyLinkCollider* ours = btMultiBodyLinkCollider::upcast(object);
  if (ours && link_collider(ours)->displaced()) displaced_.push_back(link_collider(ours));
}

void Dynamics::removeCollisionObject(btCollisionObject* object) {
  std::erase(displaced_, object);
  btMultiBodyDynamicsWorld::removeCollisionObject(object);
}

void Dynamics::predictUnconstraintMotion(btScalar length) {
  btDiscreteDynamicsWorld::predictUnconstraintMotion(length);
}

void Dynamics::integrateTransforms(btScalar length) {
  btMultiBodyDynamicsWorld::integrateTransforms(length);
  for (LinkCollider* collider : displaced_) {
    if (collider->leader() == collider) collider->note();
  }
  for (LinkCollider* collider : displaced_) collider->settle();
}

void Dynamics::calculateSimulationIslands() {
  btMultiBodyDynamicsWorld::calculateSimulationIslands();
  for (const LinkCollider* collider : displaced_) {
    if (collider->isStaticObject() || collider->leader() == collider) continue;
    m_islandManager->getUnionFind().unite(collider->leader()->getIslandTag(),
                                          collider->getIslandTag());
  }
  if (!displaced_.empty()) m_islandManager->storeIslandActivationState(this);
}

void Dynamics::updateAabbs() {
  // 1 mm, and what forces may add within the substep: up to a few times gravity.
  const btScalar least = btScalar(1e-3) + btScalar(15) * length_ * length_;
  for (int i = 0; i < m_collisionObjects.size(); ++i) {
    btCollisionObject& object = *m_collisionObjects[i];
    auto& collider = *static_cast<contact::Collider*>(object.getUserPointer());
    const bool fixed = object.isStaticObject();
    if (fixed ? collider.reach == least : !object.isActive()) continue;
    collider.reach =
        fixed ? least : least + btScalar(1.3) * length_ * surface_speed(object, collider, length_);
    collider.previous = object.getWorldTransform();
    btVector3 low, high;
    object.getCollisionShape()->getAabb(object.getWorldTransform(), low, high);
    const btVector3 reach(collider.reach, collider.reach, collider.reach);
    keep_in_box(*object.getBroadphaseHandle(), low - reach, high + reach);
  }
}

}  // namespace ziggurat::physics
