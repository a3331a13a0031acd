#include "physics/bullet/contacts.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>

#include "physics/contact/algorithm.h"
#include "physics/convert.h"

namespace ziggurat::physics {
namespace {

ContactSide side(const btCollisionObject& object) {
  const contact::Collider& collider = contact::collider_of(object);
  return {collider.entity, collider.link};
}

/// Whether a point presses, or its surfaces meet.
bool touches(const btManifoldPoint& point) {
  return point.m_appliedImpulse > 0 || point.m_distance1 <= 0;
}

/// On the manifold's first body [N s].
btVector3 impulse(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

}  // namespace

void collect(btDispatcher& dispatcher, std::vector<LinkContact>& out) {
  out.clear();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    btVector3 middle(0, 0, 0), sum(0, 0, 0);
    int count = 0;
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      const btManifoldPoint& point = manifold.getContactPoint(j);
      if (!touches(point)) continue;
      middle += point.m_positionWorldOnB;
      sum += impulse(point);
      ++count;
    }
    if (count == 0) continue;
    out.push_back(in_order({side(*manifold.getBody0()), side(*manifold.getBody1()),
                            from_bullet(manifold.getContactPoint(0).m_normalWorldOnB),
                            from_bullet(middle / count), from_bullet(sum)}));
  }
  sort(out);
}

}  // namespace ziggurat::physics
