// SPDX-License-Identifier: MIT
// Internal edges between colliders that stand flush beside each other, in the world or in one body,
// get no contacts.

#include <algorithm>

#include "physics/bodies/convert.h"
#include "physics/collision/contact_cache.h"

namespace ziggurat::physics {
namespace {

constexpr btScalar most_step = 1e-5;  // largest step in a surface that counts as flush [m]
constexpr btScalar slack = 1e-4;      // tolerance of points inside a collider [m]

/// Height of a collider along a direction, from the world's origin [m].
btScalar support_height(const Collider& collider, const btVector3& up) {
  const btVector3 in_it = collider.pose.getBasis().transpose() * up;
  return up.dot(collider.pose.getOrigin()) + contact::reach_along(collider.shape, in_it);
}

}  // namespace

/// Whether a point on the base of `cover` is inside of another collider of that base near the
/// mover, which ends flush with it. The pair of `hidden` does not count. Notes the pair, rather one
/// without contacts.
/// @param height  of the surface of `cover` along `up` [m]
bool ContactCache::is_inside_neighbour(const Collider& cover, const CachedPair& hidden,
                                       std::size_t mover, const btVector3& up, btScalar height,
                                       const btVector3& point) {
  neighbours_.clear();
  pairs_of_collider_.collect(mover, neighbours_);
  CachedPair* carrier = nullptr;
  for (const int number : neighbours_) {
    CachedPair& pair = pairs_[number];
    const Collider& other = colliders_.all[pair.a == mover ? pair.b : pair.a];
    const bool same_base =
        cover.moves ? other.entity == cover.entity && other.part == cover.part : !other.moves;
    if (!same_base || !other.is_present || &pair == &hidden ||
        btFabs(support_height(other, up) - height) > most_step ||
        !contact::contains(other.shape, other.pose.invXform(point), slack)) {
      continue;
    }
    if (pair.count == 0) return true;
    carrier = &pair;
  }
  if (carrier != nullptr) carriers_.push_back(carrier);
  return carrier != nullptr;
}

/// Drops the contacts of a collider with `hidden` if they lie on an internal edge that `seen`
/// covers. Then `hidden` is nowhere above the surface of `seen`, which continues at the contacts,
/// also in its neighbours. Both belong to one body, or stand. Covering pairs are kept: where four
/// tiles meet, two would hide each other.
bool ContactCache::drops_internal_edge(CachedPair& seen, CachedPair& hidden, std::size_t mover) {
  if (hidden.covers_internal_edge) return false;
  carriers_.assign(1, &seen);
  const bool seen_first = seen.b == mover, hidden_first = hidden.b == mover;
  const Collider& cover = colliders_.all[seen_first ? seen.a : seen.b];
  const Collider& other = colliders_.all[hidden_first ? hidden.a : hidden.b];
  const btVector3 up = to_bullet(seen_first ? math::Vector3(-seen.normal) : seen.normal);
  const CachedPoint& on = seen.points[0];
  const btScalar height = up.dot(cover.pose * to_bullet(seen_first ? on.on_a : on.on_b));
  if (support_height(other, up) > height + most_step) return false;
  for (int i = 0; i < hidden.count; ++i) {
    const CachedPoint& point = hidden.points[i];
    const btVector3 at = other.pose * to_bullet(hidden_first ? point.on_a : point.on_b);
    if (contact::contains(cover.shape, cover.pose.invXform(at), slack)) continue;
    if (!is_inside_neighbour(cover, hidden, mover, up, height, at)) return false;
  }
  for (CachedPair* carrier : carriers_) carrier->covers_internal_edge = true;
  hidden.count = 0;
  return true;
}

/// Notes the supports of a touching pair: each moving side, on a base with several colliders.
void ContactCache::list_supports(const CachedPair& pair) {
  const int number = static_cast<int>(&pair - pairs_.data());
  const auto note = [&](std::size_t mover, std::size_t on) {
    const Collider& base = colliders_.all[on];
    if (!base.moves) {
      supports_.push_back({mover, Collider::floor, 0, on, number});
    } else if (colliders_.groups[base.group].count > 1) {
      supports_.push_back({mover, base.entity, base.part, on, number});
    }
  };
  if (colliders_.all[pair.a].moves) note(pair.a, pair.b);
  if (colliders_.all[pair.b].moves) note(pair.b, pair.a);
}

/// Notes the supports of all touching pairs. The floor counts only below what also touches
/// something else that stands.
void ContactCache::list_supports() {
  supports_.clear();
  const auto is_on_floor = [&](const ListedPair& listed) {
    return pairs_[listed.pair].b == colliders_.floor;
  };
  for (const ListedPair& listed : listed_) {
    if (listed.count > 0 && !is_on_floor(listed)) list_supports(pairs_[listed.pair]);
  }
  if (supports_.empty()) return;
  std::ranges::sort(supports_);
  const std::size_t movers = supports_.size();
  for (const ListedPair& listed : listed_) {
    if (listed.count == 0 || !is_on_floor(listed)) continue;
    const auto sorted = std::span(supports_).first(movers);
    if (std::ranges::binary_search(sorted, std::size_t{pairs_[listed.pair].a}, {}, &Support::mover))
      list_supports(pairs_[listed.pair]);
  }
}

/// Drops contacts with internal edges, between colliders that stand flush beside each other, in the
/// world or in one body.
void ContactCache::drop_internal_edges() {
  if (!std::ranges::is_sorted(supports_)) std::ranges::sort(supports_);
  const auto same_base = [](const Support& a, const Support& b) {
    return a.mover == b.mover && a.entity == b.entity && a.part == b.part;
  };
  bool dropped = false;
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    const Support& one = supports_[i];
    CachedPair& pair = pairs_[one.pair];
    for (std::size_t j = i; j-- > 0 && same_base(supports_[j], one) && pair.count > 0;) {
      CachedPair& other = pairs_[supports_[j].pair];
      if (other.count == 0) continue;
      dropped |= drops_internal_edge(other, pair, one.mover) ||
                 drops_internal_edge(pair, other, one.mover);
    }
  }
  if (dropped) keep_if([](const CachedPair& pair) { return pair.count > 0; });
}

}  // namespace ziggurat::physics
