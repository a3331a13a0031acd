#include "physics/contact/algorithm.h"

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <iterator>

namespace ziggurat::physics::contact {
namespace {

/// Anchor of a contact where it first stuck: a point on either body, in that body's frame. Bullet's
/// friction only stops velocities; pulling a contact back to its anchor stops creep, too.
struct Anchor {
  btVector3 on_a, on_b;
};

/// Beyond this slip a contact slides and is anchored anew [m].
constexpr btScalar slip_limit = 2e-4;
/// Beyond this an anchor has left the surface: the body rolls, and is anchored anew. Held longer,
/// a wheel would be pulled back against its rolling and lag behind its encoder [m].
constexpr btScalar lift_limit = 2e-5;

class Algorithm final : public btActivatingCollisionAlgorithm {
 public:
  Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
            const btCollisionObjectWrapper* b)
      : btActivatingCollisionAlgorithm(info, a, b) {
    if (m_dispatcher->needsCollision(a->getCollisionObject(), b->getCollisionObject())) {
      manifold_ = m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject());
    }
  }
  ~Algorithm() override {
    if (manifold_) m_dispatcher->releaseManifold(manifold_);
  }

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    if (!manifold_) return;
    result->setPersistentManifold(manifold_);
    const btCollisionObject& object_a = *a->getCollisionObject();
    const btCollisionObject& object_b = *b->getCollisionObject();
    const Collider& collider_a = collider_of(object_a);
    const Collider& collider_b = collider_of(object_b);
    const btScalar reach = collider_a.reach + collider_b.reach;
    Manifold contacts = find(collider_a.shape, object_a.getWorldTransform(), collider_b.shape,
                             object_b.getWorldTransform(), reach);
    // Sorted in the frame of a body that moves: sorted in the floor's, a robot that turns would
    // be solved in another order for each heading, and drift that way.
    reduce(contacts, (object_a.isStaticObject() ? object_b : object_a).getWorldTransform());
    write(contacts, collider_a, collider_b, reach);
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_) manifolds.push_back(manifold_);
  }

  struct Create final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override {
      void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
      return new (memory) Algorithm(info, a, b);
    }
  };

 private:
  /// State that is carried over from the last step's point.
  struct Old {
    btVector3 local_b;
    btScalar impulse;
    Anchor anchor;
    bool taken = false;
  };

  void write(const Manifold& contacts, const Collider& a, const Collider& b, btScalar reach);
  btVector3 slip(const btManifoldPoint& point, const Old* old, Anchor& anchor) const;
  void take_back(const std::array<btVector3, 4>& slips);

  btPersistentManifold* manifold_ = nullptr;
  std::array<Anchor, 4> anchors_;
};

/// Whether a contact is one of a wheeled body's lower or upper face.
bool rolls_on(const Collider& collider, const btTransform& pose, const btVector3& normal) {
  constexpr btScalar face = btScalar(0.7);  // cosine of the steepest such contact
  return collider.rolls && btFabs(pose.getBasis().getColumn(2).dot(normal)) > face;
}

/// Replaces the manifold's points, carrying impulses and anchors over to the nearest new ones.
void Algorithm::write(const Manifold& contacts, const Collider& a, const Collider& b,
                      btScalar reach) {
  std::array<Old, 4> old;
  const int old_count = manifold_->getNumContacts();
  for (int i = 0; i < old_count; ++i) {
    const btManifoldPoint& point = manifold_->getContactPoint(i);
    old[i] = {point.m_localPointB, point.m_appliedImpulse, anchors_[i]};
  }
  manifold_->clearManifold();
  manifold_->setContactBreakingThreshold(reach);

  const btTransform& pose_a = manifold_->getBody0()->getWorldTransform();
  const btTransform& pose_b = manifold_->getBody1()->getWorldTransform();
  const bool rolls = rolls_on(a, pose_a, contacts.normal) || rolls_on(b, pose_b, contacts.normal);
  std::array<btVector3, 4> slips;
  for (int i = 0; i < contacts.count; ++i) {
    const ManifoldPoint& contact = contacts.points[i];
    const btVector3 on_a = contact.on_b + contacts.normal * contact.distance;
    btManifoldPoint point(pose_a.invXform(on_a), pose_b.invXform(contact.on_b), contacts.normal,
                          contact.distance);
    point.m_positionWorldOnA = on_a;
    point.m_positionWorldOnB = contact.on_b;
    point.m_combinedFriction = rolls ? 0 : a.friction * b.friction;
    // Only a point or a line of contact can roll; each carries its share of the normal force.
    if (contacts.count <= 2)
      point.m_combinedRollingFriction = a.rolling_friction + b.rolling_friction;

    Old* nearest = nullptr;
    btScalar least = btScalar(25e-6);  // 5 mm apart is another contact [m^2]
    for (int j = 0; j < old_count; ++j) {
      const btScalar away = (old[j].local_b - point.m_localPointB).length2();
      if (!old[j].taken && away < least) least = away, nearest = &old[j];
    }
    if (nearest) {
      nearest->taken = true;
      point.m_appliedImpulse = nearest->impulse;
    }
    slips[i] = slip(point, nearest, anchors_[i]);
    manifold_->addManifoldPoint(point, true);
  }
  take_back(slips);
}

/// Slip of a contact from its anchor, in the tangent plane [m]; sets the anchor.
btVector3 Algorithm::slip(const btManifoldPoint& point, const Old* old, Anchor& anchor) const {
  anchor = {point.m_localPointA, point.m_localPointB};
  if (!old) return btVector3(0, 0, 0);
  btVector3 slip = manifold_->getBody0()->getWorldTransform() * old->anchor.on_a -
                   manifold_->getBody1()->getWorldTransform() * old->anchor.on_b;
  const btScalar apart = slip.dot(point.m_normalWorldOnB);
  if (btFabs(apart - point.m_distance1) > lift_limit) return btVector3(0, 0, 0);
  slip -= point.m_normalWorldOnB * apart;
  const btScalar length = slip.length();
  if (length > slip_limit) return slip * (slip_limit / length);
  anchor = old->anchor;
  return slip;
}

/// Tells Bullet the slips to take back. Anchors set at different times conflict a little, and four
/// conflicting points would push each other forever. The target is the rigid motion in the tangent
/// plane that fits them best.
void Algorithm::take_back(const std::array<btVector3, 4>& slips) {
  const int count = manifold_->getNumContacts();
  if (count == 0) return;
  const btVector3 normal = manifold_->getContactPoint(0).m_normalWorldOnB;
  btVector3 middle(0, 0, 0), shift(0, 0, 0);
  for (int i = 0; i < count; ++i) {
    middle += manifold_->getContactPoint(i).m_positionWorldOnB;
    shift += slips[i];
  }
  middle /= btScalar(count);
  shift /= btScalar(count);
  btScalar moment = 0, spread = 0;
  for (int i = 0; i < count; ++i) {
    const btVector3 arm = manifold_->getContactPoint(i).m_positionWorldOnB - middle;
    moment += arm.cross(slips[i]).dot(normal);
    spread += arm.length2();
  }
  const btScalar turn = spread > 0 ? moment / spread : 0;
  for (int i = 0; i < count; ++i) {
    btManifoldPoint& point = manifold_->getContactPoint(i);
    const btVector3 arm = point.m_positionWorldOnB - middle;
    point.m_contactPointFlags |= BT_CONTACT_FLAG_FRICTION_ANCHOR;
    point.m_positionWorldOnA =
        point.m_positionWorldOnB + normal * point.m_distance1 + shift + normal.cross(arm) * turn;
  }
}

}  // namespace

const Collider& collider_of(const btCollisionObject& object) {
  return *static_cast<const Collider*>(object.getUserPointer());
}

btDefaultCollisionConstructionInfo construction_info() {
  btDefaultCollisionConstructionInfo info;
  info.m_customCollisionAlgorithmMaxElementSize = sizeof(Algorithm);
  return info;
}

std::unique_ptr<btCollisionAlgorithmCreateFunc> register_algorithms(
    btCollisionDispatcher& dispatcher) {
  auto create = std::make_unique<Algorithm::Create>();
  constexpr int types[] = {BOX_SHAPE_PROXYTYPE,         CYLINDER_SHAPE_PROXYTYPE,
                           SPHERE_SHAPE_PROXYTYPE,      CAPSULE_SHAPE_PROXYTYPE,
                           CONVEX_HULL_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE};
  static_assert(std::size(types) == std::variant_size_v<Shape>);
  for (const int a : types) {
    for (const int b : types) dispatcher.registerCollisionCreateFunc(a, b, create.get());
  }
  return create;
}

}  // namespace ziggurat::physics::contact
