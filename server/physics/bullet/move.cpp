#include "physics/bullet/move.h"

namespace ziggurat::physics {
namespace {

void place(btCollisionObject& object, const btTransform& transform, btDynamicsWorld& world) {
  object.setWorldTransform(transform);
  object.setInterpolationWorldTransform(transform);
  static_cast<contact::Collider*>(object.getUserPointer())->previous = transform;
  if (object.getBroadphaseHandle() == nullptr) return;
  wake_neighbours(object, world);
  world.getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(
      object.getBroadphaseHandle(), world.getDispatcher());
  world.updateSingleAabb(&object);
  object.activate(true);
}

void assemble_joints(btMultiBody& multi) {
  for (int i = 0; i < multi.getNumLinks(); ++i) {
    const btMultibodyLink& link = multi.getLink(i);
    if (link.m_dofCount == 0) continue;
    btScalar position[4] = {0, 0, 0, link.m_jointType == btMultibodyLink::eSpherical ? 1.0 : 0.0};
    btScalar velocity[6] = {};
    multi.setJointPosMultiDof(i, position);
    multi.setJointVelMultiDof(i, velocity);
  }
}

void move_multi(Mechanism& mechanism, const btTransform& base, btDynamicsWorld& world) {
  btMultiBody& multi = *mechanism.multi;
  multi.setBaseWorldTransform(base);
  multi.setBaseVel(btVector3(0, 0, 0));
  multi.setBaseOmega(btVector3(0, 0, 0));
  assemble_joints(multi);
  multi.clearForcesAndTorques();
  multi.clearVelocities();
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> positions;
  multi.forwardKinematics(rotations, positions);
  multi.updateCollisionObjectWorldTransforms(rotations, positions);
  for (auto& collider : mechanism.link_colliders) {
    if (collider->leader() == collider.get()) collider->note();
  }
  for (auto& collider : mechanism.link_colliders) {
    collider->settle();
    place(*collider, collider->getWorldTransform(), world);
  }
}

}  // namespace

void wake_neighbours(const btCollisionObject& object, btDynamicsWorld& world) {
  const btBroadphasePairArray& pairs =
      world.getBroadphase()->getOverlappingPairCache()->getOverlappingPairArray();
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  for (int i = 0; i < pairs.size(); ++i) {
    if (pairs[i].m_pProxy0 != proxy && pairs[i].m_pProxy1 != proxy) continue;
    const btBroadphaseProxy* other =
        pairs[i].m_pProxy0 == proxy ? pairs[i].m_pProxy1 : pairs[i].m_pProxy0;
    static_cast<btCollisionObject*>(other->m_clientObject)->activate();
  }
}

void move(Mechanism& mechanism, const btTransform& base, btDynamicsWorld& world) {
  if (mechanism.multi) return move_multi(mechanism, base, world);
  btRigidBody& rigid = *mechanism.rigid;
  rigid.setLinearVelocity(btVector3(0, 0, 0));
  rigid.setAngularVelocity(btVector3(0, 0, 0));
  rigid.clearForces();
  place(rigid, base, world);
}

}  // namespace ziggurat::physics
