#include "physics/newton/colliders.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>

#include "physics/convert.h"
#include "physics/make_room.h"
#include "physics/newton/tree.h"
#include "physics/shape.h"

namespace ziggurat::physics {
namespace {

constexpr btScalar box_slack = 1e-3;  // how much larger than needed a new box is made [m]

bool inside(const btVector3& outer_low, const btVector3& outer_high, const btVector3& low,
            const btVector3& high) {
  return outer_low.x() <= low.x() && outer_low.y() <= low.y() && outer_low.z() <= low.z() &&
         outer_high.x() >= high.x() && outer_high.y() >= high.y() && outer_high.z() >= high.z();
}

std::size_t index_of(const btBroadphaseProxy& proxy) {
  return reinterpret_cast<std::size_t>(proxy.m_clientObject);
}

/// A link's collider, without a place. None if nothing touches the link by itself.
std::optional<Collider> make_collider(const Body& body, const scene::Entity& entity,
                                      std::size_t i) {
  const scene::Link& link = entity.links[i];
  const LinkBody& placed = body.links[i];
  if (!link.collides || placed.carrier != LinkBody::carries_itself) return std::nullopt;
  Collider collider;
  collider.shape = contact_shape(link.geometry);
  collider.entity = body.entity;
  collider.link = i;
  collider.part = placed.part;
  collider.in_part = to_bullet(placed.in_part);
  collider.centred = collider.in_part == btTransform::getIdentity();
  collider.moves = body.parts[placed.part].moves;
  collider.rolls = body.ground.has_value() && i == 0;
  collider.surface = link.surface;
  collider.outline = bullet_shape(link.geometry);
  collider.smallest = placed.half_extents.minCoeff();
  collider.radius = contact::bounding_radius(collider.shape);
  return collider;
}

}  // namespace

/// Links of one entity do not touch each other, nor do two that stand.
struct Colliders::Filter final : btOverlapFilterCallback {
  explicit Filter(const std::vector<Collider>& all) : colliders(all) {}
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const Collider& one = colliders[index_of(*a)];
    const Collider& other = colliders[index_of(*b)];
    return one.entity != other.entity && (one.moves || other.moves);
  }
  const std::vector<Collider>& colliders;
};

double least_reach(double length) { return 1e-3 + 15 * length * length; }

Colliders::Colliders() : filter_(std::make_unique<Filter>(all)) {
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(filter_.get());
}

Colliders::~Colliders() {
  for (Collider& collider : all) {
    if (collider.proxy) broadphase_.destroyProxy(collider.proxy, nullptr);
  }
}

void Colliders::add_floor(const scene::Surface& surface) {
  floor = all.size();
  Collider& collider = all.emplace_back();
  collider.shape = contact::HalfSpace{};
  collider.surface = surface;
}

void Colliders::add(const Body& body, const scene::Entity& entity, const dynamics::Tree& tree) {
  std::vector<Collider> made;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    if (auto collider = make_collider(body, entity, i)) made.push_back(std::move(*collider));
  }
  make_room(all, made.size());
  for (Collider& collider : made) {  // only Bullet allocates, which does not throw
    place(collider, tree);
    all.push_back(std::move(collider));
    insert(all.back(), all.size() - 1);
  }
}

void Colliders::insert(Collider& collider, std::size_t index) {
  btVector3 low, high;
  collider.outline->getAabb(collider.pose, low, high);
  collider.proxy =
      broadphase_.createProxy(low, high, 0, reinterpret_cast<void*>(index), 1, 1, nullptr);
}

void Colliders::remove(std::size_t entity) {
  for (Collider& collider : all) {
    if (collider.entity != entity || !collider.proxy) continue;
    broadphase_.destroyProxy(collider.proxy, nullptr);
    collider = {};
  }
  while (!all.empty() && !all.back().proxy && floor != all.size() - 1) all.pop_back();
}

void Colliders::moved(std::size_t entity, const dynamics::Tree& tree) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    Collider& collider = all[i];
    if (collider.entity != entity || !collider.proxy) continue;
    collider.rests = false;
    place(collider, tree);
    broadphase_.destroyProxy(collider.proxy, nullptr);
    insert(collider, i);
  }
}

void Colliders::place(Collider& collider, const dynamics::Tree& tree) const {
  collider.pose = transform_of(tree, collider.part);
  if (!collider.centred) collider.pose *= collider.in_part;
  if (!collider.moves) return;
  const dynamics::Motion& motion = tree.motion[collider.part];
  const math::Vector3 arm = from_bullet(collider.pose.getOrigin()) - tree.origin;
  collider.velocity = to_bullet(motion.linear + motion.angular.cross(arm));
  collider.angular_velocity = to_bullet(motion.angular);
}

btTransform Colliders::pose(const Collider& collider, const dynamics::System& system) const {
  return transform_of(system.trees[collider.entity], collider.part) * collider.in_part;
}

/// Bullet's boxes only grow: a body that fell fast would keep a large one, and a neighbour in
/// each pair it makes, forever. Ours are renewed when too small or much too large.
void Colliders::keep_in_box(Collider& collider) {
  const btVector3 reach(collider.reach, collider.reach, collider.reach);
  const btVector3 slack(box_slack, box_slack, box_slack);
  btVector3 low, high;
  collider.outline->getAabb(collider.pose, low, high);
  low -= reach, high += reach;
  const btBroadphaseProxy& proxy = *collider.proxy;
  if (inside(proxy.m_aabbMin, proxy.m_aabbMax, low, high) &&
      inside(low - 3 * slack, high + 3 * slack, proxy.m_aabbMin, proxy.m_aabbMax)) {
    return;
  }
  broadphase_.setAabbForceUpdate(collider.proxy, low - slack, high + slack, nullptr);
}

void Colliders::follow(const dynamics::System& system, double length) {
  const double least = least_reach(length);
  for (Collider& collider : all) {
    if (!collider.proxy) continue;
    if (!collider.moves) {
      collider.rests = true;
      if (collider.reach == least) continue;
      collider.reach = least;
      keep_in_box(collider);
      continue;
    }
    const bool slept = collider.rests;
    collider.rests = system.asleep(static_cast<int>(collider.entity));
    if (slept && collider.rests) continue;
    place(collider, system.trees[collider.entity]);
    const double speed =
        collider.velocity.length() + collider.angular_velocity.length() * collider.radius;
    collider.reach = least + 1.3 * length * speed;
    keep_in_box(collider);
  }
}

void Colliders::find_near(std::vector<Near>& out) {
  out.clear();
  broadphase_.calculateOverlappingPairs(nullptr);
  btBroadphasePairArray& pairs = broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    btBroadphasePair& pair = pairs[i];
    std::size_t a = index_of(*pair.m_pProxy0), b = index_of(*pair.m_pProxy1);
    if (b < a) std::swap(a, b);
    out.push_back({a, b, &pair.m_internalTmpValue});
  }
}

}  // namespace ziggurat::physics
