// SPDX-License-Identifier: MIT
// Pairs of colliders in the contact cache, and their impulses.

#include <algorithm>

#include "physics/collision/contact_cache.h"
#include "physics/multibody/prefetch.h"
#include "physics/stepping/team.h"

namespace ziggurat::physics {
namespace {

ContactSide side(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {collider.entity, collider.link};
}

}  // namespace

/// Returns the number of a pair; makes a new one where there is none.
/// @param place  its number, or 0
int ContactCache::place_of(std::size_t a, std::size_t b, int& place) {
  if (place != 0) return place;
  if (unused_.empty()) {
    if (pairs_.empty()) pairs_.emplace_back();
    unused_.push_back(static_cast<int>(pairs_.size()));
    pairs_.emplace_back();
    unused_.reserve(pairs_.capacity());  // drop_pair() and forget() take no memory
    forgotten_.reserve(pairs_.capacity());
    pairs_of_collider_.make_room(pairs_.size());
  }
  place = unused_.back();
  unused_.pop_back();
  pairs_[place] = {};
  pairs_[place].a = static_cast<std::uint32_t>(a);
  pairs_[place].b = static_cast<std::uint32_t>(b);
  pairs_[place].live = true;
  pairs_of_collider_.add(place, a, b == colliders_.floor ? std::nullopt : std::optional(b));
  ++live_;
  return place;
}

void ContactCache::drop_pair(std::size_t number) {
  CachedPair& pair = pairs_[number];
  pairs_of_collider_.remove(static_cast<int>(number));
  pair.live = false;
  pair.count = 0;
  --live_;
  resting_ -= pair.is_static;
  unused_.push_back(static_cast<int>(number));
  if (colliders_.floor != pair.b) {
    places_.erase(key_of(pair.a, pair.b));
  } else if (pair.a < floor_pairs_.size()) {
    floor_pairs_[pair.a] = 0;
  }
}

/// Drops pairs that came apart.
void ContactCache::drop_separated_pairs() {
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    const CachedPair& pair = pairs_[i];
    if (!pair.live || pair.last_substep == substep_) continue;
    const bool rests = colliders_.is_static(colliders_.all[pair.a]) &&
                       colliders_.is_static(colliders_.all[pair.b]);
    if (!rests) drop_pair(i);
  }
}

void ContactCache::forget(std::size_t entity, dynamics::System& system) {
  forgotten_.clear();
  for (const ColliderGroup& group : colliders_.groups_of(entity)) {
    for (std::size_t i = 0; i < group.count; ++i)
      pairs_of_collider_.collect(group.first + i, forgotten_);
  }
  std::sort(forgotten_.begin(), forgotten_.end());  // the lists' order is no state
  for (const int number : forgotten_) {
    for (const std::size_t i : {pairs_[number].a, pairs_[number].b}) {
      const std::size_t other = colliders_.all[i].entity;
      if (other != Collider::floor) system.wake(static_cast<int>(other));
    }
    drop_pair(static_cast<std::size_t>(number));
  }
}

void ContactCache::store_impulses(bool more) {
  constexpr std::size_t block = 32, later = 4;
  dynamics::share_in_blocks(team_, listed_.size(), block, [&](std::size_t number, unsigned) {
    if (number + later < listed_.size()) {
      const ListedPair& next = listed_[number + later];
      dynamics::prefetch(&pairs_[next.pair], CachedPair::prefetched_bytes);
    }
    const ListedPair& listed = listed_[number];
    CachedPair& pair = pairs_[listed.pair];
    for (int i = 0; i < listed.count; ++i) {
      const dynamics::ContactPoint& contact = contacts_[listed.first + i];
      if (more) pair.earlier_impulse += contact.impulse;
      if (force_share_ == 0) continue;
      pair.points[i].impulse = contact.impulse / force_share_;
      pair.points[i].angular_impulse = contact.angular_impulse / force_share_;
      pair.points[i].carried = !contact.impulse.isZero(0);
      pair.force_share = force_share_;
    }
  });
}

void ContactCache::store_estimates() {
  if (force_share_ == 0) return;
  for (const ListedPair& listed : listed_) {
    for (int i = 0; i < listed.count; ++i) {
      const dynamics::ContactPoint& contact = contacts_[listed.first + i];
      CachedPoint& point = pairs_[listed.pair].points[i];
      point.impulse = contact.impulse / force_share_;
      point.angular_impulse = contact.angular_impulse / force_share_;
    }
  }
}

void ContactCache::add_impact_impulses() {
  for (const ListedPair& listed : listed_) {
    for (int i = 0; i < listed.count; ++i)
      pairs_[listed.pair].earlier_impulse += contacts_[listed.first + i].impulse;
  }
}

void ContactCache::list_contacts(std::vector<LinkContact>& out) const {
  out.clear();
  for (const CachedPair& pair : pairs_) {
    math::Vector3 middle(0, 0, 0), sum = pair.earlier_impulse;
    int count = 0;
    for (int i = 0; i < pair.count; ++i) {
      const CachedPoint& point = pair.points[i];
      const bool pressed = point.impulse.dot(pair.normal) > 0 || !pair.earlier_impulse.isZero(0);
      if (!pressed && point.gap > 0) continue;
      middle += point.point;
      sum += pair.force_share * point.impulse;
      ++count;
    }
    const bool came_apart = pair.live && pair.count == 0 && pair.last_substep == substep_ &&
                            !pair.earlier_impulse.isZero(0);
    if (came_apart) middle = pair.points[0].point, count = 1;
    if (count == 0) continue;
    out.push_back(in_order({side(colliders_.all[pair.a]), side(colliders_.all[pair.b]), pair.normal,
                            middle / count, sum}));
  }
  sort(out);
}

}  // namespace ziggurat::physics
