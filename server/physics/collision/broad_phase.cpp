// SPDX-License-Identifier: MIT
// Broad phase: boxes of groups of colliders in Bullet's trees, and the pairs whose boxes meet.

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <tuple>

#include "physics/collision/colliders.h"
#include "physics/collision/contact_limits.h"
#include "physics/collision/sphere_grid.h"

namespace ziggurat::physics {
namespace {

// Slack of a new box: some steps at the present speed, at most a share of its size, at least this
// distance [m].
constexpr double least_slack = 1e-3;
constexpr double steps_ahead = 12;
constexpr double share_of_size = 0.1;

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

/// Slack of a group's new box.
/// @param step  how far it moves in the substep [m]
btVector3 slack_of(const ColliderGroup& group, double step) {
  const btVector3 size = group.high - group.low;
  const double most = share_of_size * std::min({size.x(), size.y(), size.z()});
  const double ahead = std::max(least_slack, std::min(steps_ahead * step, most));
  return {ahead, ahead, ahead};
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

/// Frees the proxies alone: destroyProxy() would take 40 000 leaves from trees that go as a whole.
Colliders::~Colliders() {
  for (ColliderGroup& group : groups) btAlignedFree(group.proxy);
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
