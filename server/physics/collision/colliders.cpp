// SPDX-License-Identifier: MIT
#include "physics/collision/colliders.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <tuple>

#include "physics/bodies/convert.h"
#include "physics/collision/contact_limits.h"
#include "physics/collision/shape.h"
#include "physics/collision/sphere_grid.h"
#include "physics/multibody/prefetch.h"

namespace ziggurat::physics {
namespace {

// Slack of a new box: some steps at the present speed, at most a share of its size, at least this
// distance [m].
constexpr double least_slack = 1e-3;
constexpr double steps_ahead = 12;
constexpr double share_of_size = 0.1;

constexpr std::size_t most_ahead = 8;  // colliders that are prefetched

bool inside(const btVector3& outer_low, const btVector3& outer_high, const btVector3& low,
            const btVector3& high) {
  return outer_low.x() <= low.x() && outer_low.y() <= low.y() && outer_low.z() <= low.z() &&
         outer_high.x() >= high.x() && outer_high.y() >= high.y() && outer_high.z() >= high.z();
}

bool boxes_meet(const Bounds& a, const Bounds& b) {
  return a.low.x() <= b.high.x() && b.low.x() <= a.high.x() && a.low.y() <= b.high.y() &&
         b.low.y() <= a.high.y() && a.low.z() <= b.high.z() && b.low.z() <= a.high.z();
}

std::size_t index_of(const btBroadphaseProxy& proxy) {
  return reinterpret_cast<std::size_t>(proxy.m_clientObject);
}

/// Makes a link's collider, without a pose. None if the link has no contacts of its own.
std::optional<Collider> make_collider(const Body& body, const scene::Entity& entity,
                                      std::size_t i) {
  const scene::Link& link = entity.links[i];
  const LinkBody& placed = body.links[i];
  if (!link.collides || placed.carrier != LinkBody::carries_itself) return std::nullopt;
  Collider collider;
  collider.is_present = true;
  collider.shape = contact_shape(link.geometry);
  collider.entity = body.entity;
  collider.link = i;
  collider.part = static_cast<std::uint32_t>(placed.part);
  collider.in_part = to_bullet(placed.in_part);
  collider.is_centred = collider.in_part == btTransform::getIdentity();
  collider.is_turned = collider.in_part.getBasis() != btMatrix3x3::getIdentity();
  collider.moves = body.parts[placed.part].moves;
  collider.is_on_fixed_base = collider.moves && !entity.movable;
  collider.is_single_body = entity.movable && body.parts.size() == 1 && collider.is_centred;
  collider.has_wheels = body.ground.has_value() && i == 0;
  collider.surface = link.surface;
  collider.half_extents = to_bullet(placed.half_extents);
  collider.radius = contact::bounding_radius(collider.shape);
  return collider;
}

/// Slack of a group's new box.
/// @param step  how far it moves in the substep [m]
btVector3 slack_of(const ColliderGroup& group, double step) {
  const btVector3 size = group.high - group.low;
  const double most = share_of_size * std::min({size.x(), size.y(), size.z()});
  const double ahead = std::max(least_slack, std::min(steps_ahead * step, most));
  return {ahead, ahead, ahead};
}

/// Largest speed of a point of a collider [m/s].
double speed_of(const Collider& collider) {
  return collider.velocity.length() + collider.angular_velocity.length() * collider.radius;
}

}  // namespace

/// Links of one entity do not touch each other, nor do two that stand.
struct Colliders::Filter final : btOverlapFilterCallback {
  explicit Filter(const std::vector<ColliderGroup>& all) : groups(all) {}
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const ColliderGroup& one = groups[index_of(*a)];
    const ColliderGroup& other = groups[index_of(*b)];
    return one.entity != other.entity && (one.moves || other.moves);
  }
  const std::vector<ColliderGroup>& groups;
};

/// Collects the groups whose boxes meet one.
struct Colliders::Hits final : btBroadphaseAabbCallback {
  explicit Hits(std::vector<std::size_t>& out) : found(out) {}
  bool process(const btBroadphaseProxy* proxy) override {
    found.push_back(index_of(*proxy));
    return true;
  }
  std::vector<std::size_t>& found;
};

Colliders::Colliders() : filter_(std::make_unique<Filter>(groups)) {
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(filter_.get());
}

double speculative_margin(const Colliders& colliders, double time_step) {
  return 1e-3 + std::max(15.0, 1.5 * colliders.gravity) * time_step * time_step;
}

/// Removes all pairs first, at once: a box without pairs is gone in logarithmic time.
/// Frees the proxies alone: destroyProxy() would take 40 000 leaves from trees that go as a whole.
Colliders::~Colliders() {
  for (ColliderGroup& group : groups) btAlignedFree(group.proxy);
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
  make_room(groups, made.size());
  follow_anew();
  for (Collider& collider : made) {  // only Bullet allocates, which does not throw
    set_pose(collider, tree);
    // Static links have a box each, which is tighter: they never leave it.
    const bool joins = &collider != &made.front() && collider.moves && groups.back().moves;
    if (!joins) groups.push_back({collider.entity, all.size(), 0, collider.moves});
    ++groups.back().count;
    collider.group = groups.size() - 1;
    all.push_back(std::move(collider));
  }
  for (std::size_t i = groups.size(); i > 0 && groups[i - 1].entity == body.entity; --i) {
    enclose(groups[i - 1]);
  }
}

Bounds Collider::bounds() const {
  btVector3 extent =
      pose.getBasis().absolute() * half_extents;  // at most that of the bounding sphere
  extent.setMin(btVector3(radius, radius, radius));
  extent += btVector3(reach, reach, reach);
  return {pose.getOrigin() - extent, pose.getOrigin() + extent};
}

/// Sets a group's box about its colliders.
void Colliders::enclose(ColliderGroup& group) {
  group.low.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  group.high = -group.low;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    const Bounds bounds = all[i].bounds();
    group.low.setMin(bounds.low);
    group.high.setMax(bounds.high);
  }
}

void Colliders::insert(ColliderGroup& group, std::size_t index) {
  group.proxy = broadphase_.createProxy(group.low, group.high, 0, reinterpret_cast<void*>(index), 1,
                                        1, nullptr);
}

/// Inserts new groups into the broad phase in bit-reversed order: 40 000 boxes in a row took
/// minutes.
void Colliders::insert_new_groups() {
  in_bit_reversed_order(groups.size() - inserted_,
                        [&](std::size_t i) { insert(groups[inserted_ + i], inserted_ + i); });
  inserted_ = groups.size();
}

int Colliders::tree_depth() {
  insert_new_groups();
  return std::max(btDbvt::maxdepth(broadphase_.m_sets[0].m_root),
                  btDbvt::maxdepth(broadphase_.m_sets[1].m_root));
}

std::span<ColliderGroup> Colliders::groups_of(std::size_t entity) {
  const auto first = std::ranges::lower_bound(groups, entity, {}, &ColliderGroup::entity);
  const auto last = std::ranges::upper_bound(groups, entity, {}, &ColliderGroup::entity);
  return {first, last};
}

void Colliders::remove(std::size_t entity) {
  follow_anew();
  insert_new_groups();
  for (ColliderGroup& group : groups_of(entity)) {
    if (!group.proxy) continue;
    broadphase_.destroyProxy(group.proxy, nullptr);
    for (std::size_t i = group.first; i < group.first + group.count; ++i) all[i] = {};
    group = {};
    group.entity = entity;  // their order stays
  }
  while (!all.empty() && !all.back().is_present && floor != all.size() - 1) all.pop_back();
  while (!groups.empty() && !groups.back().proxy) groups.pop_back();
  inserted_ = groups.size();
}

void Colliders::reset_poses(std::size_t entity, const dynamics::Tree& tree) {
  follow_anew();
  insert_new_groups();
  for (ColliderGroup& group : groups_of(entity)) {
    if (!group.proxy) continue;
    group.is_static = false;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) set_pose(all[i], tree);
    broadphase_.destroyProxy(group.proxy, nullptr);
    enclose(group);
    insert(group, static_cast<std::size_t>(&group - groups.data()));
  }
}

void Colliders::set_pose(Collider& collider, const dynamics::Tree& tree) const {
  collider.pose = transform_of(tree, collider.part);
  if (!collider.is_centred) collider.pose *= collider.in_part;
  if (!collider.moves) return;
  const dynamics::Motion& motion = tree.spatial_velocity[collider.part];
  const math::Vector3 arm = from_bullet(collider.pose.getOrigin()) - tree.origin;
  collider.velocity = to_bullet(motion.linear + motion.angular.cross(arm));
  collider.angular_velocity = to_bullet(motion.angular);
}

btTransform Colliders::pose(const Collider& collider, const dynamics::System& system) const {
  const btTransform part = transform_of(system.trees[collider.entity], collider.part);
  return collider.is_centred ? part : part * collider.in_part;
}

/// Whether a group's box in the broad phase is neither too small nor much too large.
bool Colliders::fits_box(const ColliderGroup& group, double step, bool shrinks) const {
  const btBroadphaseProxy& proxy = *group.proxy;
  if (!inside(proxy.m_aabbMin, proxy.m_aabbMax, group.low, group.high)) return false;
  if (!shrinks) return true;
  const btVector3 slack = slack_of(group, step);
  return inside(group.low - 3 * slack, group.high + 3 * slack, proxy.m_aabbMin, proxy.m_aabbMax);
}

/// Updates a group's box in the broad phase when it is too small or much too large. Bullet's boxes
/// only grow: a fast body would keep a large one, with a neighbour in each pair, forever.
/// @param step     how far it moves in the substep [m]
/// @param shrinks  whether a box may be too large
void Colliders::update_box(ColliderGroup& group, double step, bool shrinks) {
  if (fits_box(group, step, shrinks)) return;
  const btVector3 slack = slack_of(group, step);
  broadphase_.setAabbForceUpdate(group.proxy, group.low - slack, group.high + slack, nullptr);
  check_near_pairs(
      static_cast<std::size_t>(broadphase_.getOverlappingPairCache()->getNumOverlappingPairs()));
}

void Colliders::update_poses(const dynamics::System& system, double time_step) {
  near_floor_.resize(all.size());
  for (std::size_t i = inserted_; i < groups.size(); ++i)
    update_poses(groups[i], system, time_step);  // with boxes that last
  insert_new_groups();
  has_woken = false;
  updated_groups_.clear();
  predicted.clear();
  fast_entities.clear();
  const double margin = speculative_margin(*this, time_step);
  if (sleep_changes_ != system.sleep_changes() || margin_ != margin) follow_anew();
  sleep_changes_ = system.sleep_changes();
  margin_ = margin;
  changed_.clear();
  const bool is_steady = passes_left_ == 0;
  if (is_steady) {
    for (const std::size_t index : followed_) follow(groups[index], system);
  } else {
    --passes_left_;
    for (ColliderGroup& group : groups) {
      if (group.proxy) follow(group, system);
    }
  }
  update_changed(system, time_step, true);
  if (!is_steady) followed_ = updated_groups_;
}

/// Updates the poses of the changed groups, and their boxes. Poses are shared by the team.
/// @param shrinks  see update_box()
void Colliders::update_changed(const dynamics::System& system, double time_step, bool shrinks) {
  constexpr std::size_t block = 16;  // groups that a thread takes at once
  const std::size_t count = changed_.size();
  steps_.resize(count);
  dynamics::share_in_blocks(team, count, block, [&](std::size_t i, unsigned) {
    ColliderGroup& group = groups[changed_[i]];
    steps_[i].length = update_poses(group, system, time_step);
    steps_[i].fits_box = fits_box(group, steps_[i].length, shrinks);
  });
  const double fast = speculative_margin(*this, time_step) / 2;
  for (std::size_t i = 0; i < count; ++i) {
    ColliderGroup& group = groups[changed_[i]];
    if (steps_[i].length > fast) fast_entities.push_back(static_cast<int>(group.entity));
    if (group.moves) updated_groups_.push_back(changed_[i]);
    if (!steps_[i].fits_box) update_box(group, steps_[i].length, shrinks);
  }
}

/// Notes whether a group stands; lists it unless it stood in the substep before and still does.
void Colliders::follow(ColliderGroup& group, const dynamics::System& system) {
  group.was_static = group.is_static;
  group.is_static = !group.moves || system.is_asleep(static_cast<int>(group.entity));
  has_woken |= group.was_static && !group.is_static;
  if (group.moves ? group.is_unchanged() : all[group.first].reach == margin_) return;
  changed_.push_back(static_cast<std::size_t>(&group - groups.data()));
}

void Colliders::update_poses(const dynamics::System& system, double time_step,
                             const TreeSet& active) {
  near_floor_.resize(all.size());
  insert_new_groups();
  updated_groups_.clear();
  predicted.clear();
  fast_entities.clear();
  changed_.clear();
  each_of(groups, active, [&](ColliderGroup& group) {
    if (!group.proxy || !group.moves) return;
    group.is_static = false;
    changed_.push_back(static_cast<std::size_t>(&group - groups.data()));
  });
  update_changed(system, time_step, false);
}

/// Prefetches the memory that update_poses() takes for the groups after one.
void Colliders::prefetch_after(const ColliderGroup& group, const dynamics::System& system) const {
  const auto later = [&](std::size_t by) -> const ColliderGroup* {
    const std::size_t index = static_cast<std::size_t>(&group - groups.data()) + by;
    return index < groups.size() && groups[index].moves ? &groups[index] : nullptr;
  };
  if (const ColliderGroup* next = later(6))
    dynamics::prefetch(&system.trees[next->entity], sizeof(dynamics::Tree));
  if (const ColliderGroup* next = later(3)) {
    const dynamics::Tree& tree = system.trees[next->entity];
    dynamics::prefetch(tree.rotation);
    dynamics::prefetch(tree.position);
    dynamics::prefetch(tree.spatial_velocity);
    dynamics::prefetch(&all[next->first], std::min(next->count, most_ahead) * sizeof(Collider));
    dynamics::prefetch(next->proxy, sizeof(*next->proxy));
  }
}

/// Updates poses and velocities of a group's colliders. It changes nothing of other groups.
/// @return  how far it moves [m]
double Colliders::update_poses(ColliderGroup& group, const dynamics::System& system,
                               double time_step) {
  const double margin = speculative_margin(*this, time_step);
  double fastest = 0;
  if (group.moves) prefetch_after(group, system);
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    Collider& collider = all[i];
    collider.reach = margin;
    if (!group.moves) continue;
    set_pose(collider, system.trees[group.entity]);
    const double speed = speed_of(collider);
    collider.reach += 1.3 * time_step * speed;
    fastest = std::max(fastest, speed);
    note_floor(i);
  }
  enclose(group);
  return time_step * fastest;
}

/// Notes whether a collider may come near the floor.
void Colliders::note_floor(std::size_t collider) {
  const Collider& it = all[collider];
  near_floor_[collider] = !(it.pose.getOrigin().z() > it.radius + it.reach);
}

bool Colliders::add_predictions(std::span<const int> trees, const dynamics::System& system,
                                double time_step) {
  bool any = false;
  const auto is_known = [&](std::size_t index, const Collider& moved) {
    const auto moves_so = [&](const Collider& known) {
      const double turns =
          (moved.angular_velocity - known.angular_velocity).length() * moved.radius;
      return time_step * ((moved.velocity - known.velocity).length() + turns) <=
             speculative_margin(*this, time_step);
    };
    return moves_so(all[index]) ||
           std::ranges::any_of(predicted, [&](const PredictedCollider& known) {
             return known.index == index && moves_so(known.collider);
           });
  };
  for (const int tree : trees) {
    for (ColliderGroup& group : groups_of(static_cast<std::size_t>(tree))) {
      double fastest = 0;
      for (std::size_t i = group.first; i < group.first + group.count; ++i) {
        Collider moved = all[i];
        set_pose(moved, system.trees[tree]);
        if (is_known(i, moved)) continue;
        const double speed = speed_of(moved);
        all[i].reach = moved.reach = std::max(
            all[i].reach, btScalar(speculative_margin(*this, time_step) + 1.3 * time_step * speed));
        note_floor(i);
        predicted.push_back({i, std::move(moved)});
        fastest = std::max(fastest, speed);
      }
      if (fastest == 0) continue;
      any = true;
      enclose(group);
      update_box(group, time_step * fastest, false);
    }
  }
  return any;
}

/// Lists the pairs of two groups whose boxes meet.
void Colliders::find_pairs(const ColliderGroup& a, const ColliderGroup& b,
                           std::vector<ColliderPair>& out) {
  const Bounds all_of_b{b.low, b.high};
  bounds_.clear();
  for (std::size_t i = a.first; i < a.first + a.count; ++i) {
    const Bounds one = all[i].bounds();
    if (!boxes_meet(one, all_of_b)) continue;
    if (bounds_.empty()) {
      for (std::size_t j = 0; j < b.count; ++j) bounds_.push_back(all[b.first + j].bounds());
    }
    for (std::size_t j = 0; j < b.count; ++j) {
      if (boxes_meet(one, bounds_[j]))
        out.push_back({std::min(i, b.first + j), std::max(i, b.first + j)});
    }
    check_near_pairs(out.size());
  }
}

/// Boxes find their pairs when they are changed; here those that came apart are dropped. Bullet's
/// own way to do that moves each box that rests for a while to a second tree, one after another.
void Colliders::find_pairs(std::vector<ColliderPair>& out) {
  out.clear();
  insert_new_groups();
  if (passes_left_ == 0 && updated_groups_.empty()) return;  // nothing moves
  broadphase_.m_sets[0].optimizeIncremental(1);
  btOverlappingPairCache& cache = *broadphase_.getOverlappingPairCache();
  const btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    btBroadphaseProxy &one = *pairs[i].m_pProxy0, &other = *pairs[i].m_pProxy1;
    const ColliderGroup& a = groups[index_of(one)];
    const ColliderGroup& b = groups[index_of(other)];
    if (a.is_unchanged() && b.is_unchanged()) continue;
    if (boxes_meet({a.low, a.high}, {b.low, b.high})) {
      find_pairs(a, b, out);
    } else if (!boxes_meet({one.m_aabbMin, one.m_aabbMax}, {other.m_aabbMin, other.m_aabbMax})) {
      cache.removeOverlappingPair(&one, &other, nullptr);  // the last one takes its place
      --i;
    }
  }
  // Bullet's order depends on the history of the broad phase, which no snapshot has.
  std::ranges::sort(out, {}, [](const ColliderPair& near) { return std::tie(near.a, near.b); });
}

void Colliders::find_pairs(std::vector<ColliderPair>& out, const TreeSet& active) {
  out.clear();
  insert_new_groups();
  Hits hits(hits_);
  for (const std::size_t index : updated_groups_) {
    const ColliderGroup& group = groups[index];
    hits_.clear();
    broadphase_.aabbTest(group.low, group.high, hits);
    std::sort(hits_.begin(), hits_.end());
    for (const std::size_t hit : hits_) {
      const ColliderGroup& other = groups[hit];
      const bool counts = !other.moves || (active.contains[other.entity] && hit > index);
      if (counts && other.entity != group.entity &&
          boxes_meet({group.low, group.high}, {other.low, other.high}))
        find_pairs(group, other, out);
    }
  }
}

}  // namespace ziggurat::physics
