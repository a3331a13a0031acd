// SPDX-License-Identifier: MIT
#include "physics/collision/contact_cache.h"

#include <algorithm>
#include <cmath>

#include "physics/bodies/convert.h"
#include "physics/collision/contact_limits.h"
#include "physics/multibody/prefetch.h"
#include "physics/stepping/team.h"

namespace ziggurat::physics {
namespace {

/// Link of a collider in its tree. All links of an entity that stands are parts of the world.
dynamics::LinkIndex link_of(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {static_cast<int>(collider.entity), static_cast<int>(collider.part)};
}

/// Whether a contact is one of a wheeled body's lower or upper face.
bool is_wheel_contact(const Collider& collider, const btVector3& normal) {
  constexpr btScalar face = btScalar(0.7);  // cosine of the steepest such contact
  return collider.has_wheels && btFabs(collider.pose.getBasis().getColumn(2).dot(normal)) > face;
}

double squared_distance(const math::Vector3& a, const math::Vector3& b) {
  return (to_bullet(a) - to_bullet(b)).length2();
}

/// Sets the points of contact of two moving colliders, see dynamics::ContactPoint. Separate
/// surfaces meet later in the substep, each with its own point.
/// @param on_a, on_b  in the colliders' frames [m]
/// @param apart       gap below which surfaces count as together [m]
void set_contact_points(const Collider& a, const math::Vector3& on_a, const Collider& b,
                        const math::Vector3& on_b, double apart, dynamics::ContactPoint& contact) {
  const math::Vector3 from = from_bullet(a.pose * to_bullet(on_a)),
                      way = from_bullet(b.pose * to_bullet(on_b)) - from;
  if (way.squaredNorm() < dynamics::touching_gap * dynamics::touching_gap) return;
  if (contact.gap > apart) {
    contact.point = from;
    contact.offset_to_b = way;
  } else {
    contact.offset_to_b = way - way.dot(contact.normal) * contact.normal;
  }
}

/// Whether a collider touches with a round surface, so that its point of contact moves on it.
bool is_round(const Collider& collider, const btVector3& normal) {
  constexpr btScalar upright =
      btScalar(0.7);  // cosine of the steepest axis of what lies on its side
  const auto lies = [&] {
    return btFabs(collider.pose.getBasis().getColumn(2).dot(normal)) < upright;
  };
  return std::holds_alternative<contact::Sphere>(collider.shape) ||
         ((std::holds_alternative<contact::Cylinder>(collider.shape) ||
           std::holds_alternative<contact::Capsule>(collider.shape)) &&
          lies());
}

/// Sets the velocity of the point of contact between a round collider and a flat one. It moves with
/// the round one's centre and the flat face's rotation, and about the normal with the round one's
/// small rotations.
void set_point_velocity(const Collider& a, const Collider& b, double time_step,
                        dynamics::ContactPoint& contact) {
  constexpr double far = 0.2;  // [rad]
  const btVector3 normal = to_bullet(contact.normal);
  const bool round_a = is_round(a, normal);
  if (round_a == is_round(b, normal)) return;
  const Collider& round = round_a ? a : b;
  const btVector3 arm =
      to_bullet(round_a ? contact.point : math::Vector3(contact.point + contact.offset_to_b)) -
      round.pose.getOrigin();
  const btScalar turning = round.angular_velocity.dot(normal);
  const bool is_ball = std::holds_alternative<contact::Sphere>(round.shape);
  if (!is_ball && time_step * btFabs(turning) > far) return;
  contact.has_point_velocity = true;
  const btVector3 face_turning = (round_a ? b : a).angular_velocity,
                  tilt = face_turning.cross(normal) * arm.dot(normal);
  contact.face_angular_velocity = from_bullet(face_turning);
  contact.point_velocity = from_bullet(
      is_ball ? round.velocity + tilt : round.velocity + tilt + turning * normal.cross(arm));
}

/// Whether each of two colliders is active, or stands.
bool both_active(std::size_t a, std::size_t b, const Colliders& colliders, const TreeSet& active) {
  const auto counts = [&](const Collider& collider) {
    return !collider.moves || active.contains[collider.entity];
  };
  return counts(colliders.all[a]) && counts(colliders.all[b]);
}

}  // namespace

dynamics::ContactPoint contact_of(const Collider& a, const Collider& b, const math::Vector3& normal,
                                  int count) {
  const bool rolls =
      is_wheel_contact(a, to_bullet(normal)) || is_wheel_contact(b, to_bullet(normal));
  dynamics::ContactPoint law;
  law.a = link_of(a);
  law.b = link_of(b);
  law.normal = normal;
  law.friction = rolls ? 0 : a.surface.friction * b.surface.friction;
  // Rolling friction acts at a point or a line of contact; each has its share of the normal force.
  if (count <= 2) {
    law.rolling_friction = a.surface.rolling_friction + b.surface.rolling_friction;
    law.spinning_friction = a.surface.spinning_friction + b.surface.spinning_friction;
  }
  law.restitution = std::max(a.surface.restitution, b.surface.restitution);
  return law;
}

std::span<dynamics::ContactPoint> ContactCache::find_contacts(double time_step) {
  ++substep_;
  force_share_ = 1;
  together_gap_ = dynamics::restitution_threshold * time_step;
  colliders_.find_pairs(near_pairs_);
  collide_pairs(time_step);
  if (colliders_.has_woken || awake_ + resting_ != live_) drop_separated_pairs();
  drop_internal_edges();
  return contacts_;
}

std::span<dynamics::ContactPoint> ContactCache::find_contacts(double time_step,
                                                              const TreeSet& active,
                                                              double force_share) {
  force_share_ = force_share;
  together_gap_ = HUGE_VAL;  // parts are short, and magnetic bonds need exact angular momentum
  colliders_.find_pairs(near_pairs_, active);
  std::swap(pairs_of_part_, pairs_of_previous_part_);
  collide_pairs(time_step);
  for (const int number :
       pairs_of_previous_part_) {  // pairs that came apart in this part of the substep
    if (pairs_[number].last_part != part_) pairs_[number].count = 0;
  }
  drop_internal_edges();
  return contacts_;
}

void ContactCache::set_team(dynamics::Team* team) {
  previous_points_.resize(team ? team->size() : 1);
  team_ = team;
}

/// Notes a pair that is to be collided.
void ContactCache::begin_pair(CachedPair& pair) {
  pair.last_part = part_;
  pair.covers_internal_edge = false;
  pairs_of_part_.push_back(static_cast<int>(&pair - pairs_.data()));
  resting_ -= pair.is_static;
  pair.is_static =
      colliders_.is_static(colliders_.all[pair.a]) && colliders_.is_static(colliders_.all[pair.b]);
  resting_ += pair.is_static;
  awake_ += !pair.is_static;
}

/// Lists all near pairs, and those with the floor.
void ContactCache::list_pairs() {
  pairs_of_part_.clear();
  awake_ = 0;
  floor_pairs_.resize(colliders_.all.size(), 0);
  pairs_of_collider_.resize(colliders_.all.size());
  for (const ColliderPair& near : near_pairs_)
    begin_pair(pair_of(near.a, near.b, places_[key_of(near.a, near.b)]));
  if (!colliders_.floor) return;
  const std::span<const std::size_t> followed = colliders_.updated_groups();
  for (std::size_t k = 0; k < followed.size(); ++k) {
    const ColliderGroup& group = colliders_.groups[followed[k]];
    const ColliderGroup& next = colliders_.groups[followed[std::min(k + 1, followed.size() - 1)]];
    for (std::size_t i = next.first; i < next.first + next.count; ++i) {
      if (floor_pairs_[i] != 0) dynamics::prefetch(&pairs_[floor_pairs_[i]], 64);
    }
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const Collider& collider = colliders_.all[i];
      if (collider.pose.getOrigin().z() > collider.radius + collider.reach) continue;
      begin_pair(pair_of(i, *colliders_.floor, floor_pairs_[i]));
    }
  }
}

/// Collides all near pairs, and those with the floor.
void ContactCache::collide_pairs(double time_step) {
  constexpr std::size_t block = 32;  // pairs that a thread takes at once
  ++part_;
  time_step_ = time_step;
  rotations_until_impact.clear();
  contacts_.clear();
  cache_indices_.clear();
  overlap_candidates_.clear();
  supports_.clear();
  list_pairs();
  const std::size_t count = pairs_of_part_.size();
  outcomes_.resize(count);
  const bool is_shared = team_ && count >= 2 * block;
  if (is_shared) {
    team_->share((count + block - 1) / block, [&](std::size_t number, unsigned member) {
      for (std::size_t i = number * block; i < std::min(count, (number + 1) * block); ++i)
        collide_pair(i, previous_points_[member]);
    });
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_shared) collide_pair(i, previous_points_.front());
    list_contacts_of(i);
  }
}

std::span<dynamics::ContactPoint> ContactCache::add_resting_contacts() {
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    CachedPair& pair = pairs_[i];
    if (!pair.live || pair.last_substep == substep_) continue;
    append_contacts(pair);
  }
  return contacts_;
}

void ContactCache::begin_parts(const TreeSet& active) {
  pairs_of_part_.clear();
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    if (pairs_[i].count > 0 && both_active(pairs_[i].a, pairs_[i].b, colliders_, active))
      pairs_of_part_.push_back(static_cast<int>(i));
  }
}

std::span<dynamics::ContactPoint> ContactCache::keep_contacts(const TreeSet& active) {
  keep_if([&](const CachedPair& pair) { return both_active(pair.a, pair.b, colliders_, active); });
  std::erase_if(overlap_candidates_, [&](const OverlapCandidate& turned) {
    return !both_active(pairs_[turned.pair].a, pairs_[turned.pair].b, colliders_, active);
  });
  return contacts_;
}

/// Collides one of pairs_of_part_. It changes nothing of other pairs.
/// @param memory  of the thread
void ContactCache::collide_pair(std::size_t index, Points& memory) {
  constexpr std::size_t later = 4;
  if (index + later < pairs_of_part_.size())
    dynamics::prefetch(&pairs_[pairs_of_part_[index + later]], CachedPair::prefetched_bytes);
  CachedPair& pair = pairs_[pairs_of_part_[index]];
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  RotationOutcome& turning = outcomes_[index] = {};
  const double slack = speculative_margin(colliders_, time_step_);
  contact::Manifold found = collide(a, b, time_step_, slack, most_points, turning);
  if (found.count == 0 && !colliders_.predicted.empty()) {
    found = collide_predicted(colliders_, pair.a, pair.b, time_step_, slack, most_points, turning);
  }
  match_points(found, pair, memory);
}

/// Lists the contacts of one of pairs_of_part_, and what else follows from them.
void ContactCache::list_contacts_of(std::size_t index) {
  constexpr std::size_t later = 4;
  if (index + later < pairs_of_part_.size())  // another thread may have collided it
    dynamics::prefetch(&pairs_[pairs_of_part_[index + later]], CachedPair::prefetched_bytes);
  CachedPair& pair = pairs_[pairs_of_part_[index]];
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const RotationOutcome& outcome = outcomes_[index];
  if (outcome.rotation_until_impact > 0)
    rotations_until_impact.push_back(
        {static_cast<int>((a.is_on_fixed_base ? a : b).entity), outcome.rotation_until_impact});
  append_contacts(pair);
  if (pair.count > 0) list_supports(pair);
  if (a.moves && b.moves) return;
  overlap_candidates_.push_back({static_cast<std::size_t>(pairs_of_part_[index]), pair.count == 0,
                                 outcome.may_overlap || outcome.tumbles});
}

/// Matches new points with those of the last substep, whose impulses they keep. The nearest point
/// counts: on either body, or moved with one.
/// @param old  memory
void ContactCache::match_points(const contact::Manifold& found, CachedPair& pair, Points& old) {
  constexpr double same = 25e-6;  // points more than 5 mm apart differ [m^2]
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const int old_count = pair.count;
  std::copy_n(pair.points.begin(), old_count, old.begin());
  std::array<bool, most_points> taken{};
  // The contact point of a rolling body moves with that body's centre.
  const math::Vector3 with_a = time_step_ * from_bullet(a.velocity),
                      with_b = time_step_ * from_bullet(b.velocity);
  pair.count = found.count;
  if (found.count > 0) pair.normal = from_bullet(found.normal);
  for (int i = 0; i < found.count; ++i) {
    const contact::ManifoldPoint& point = found.points[i];
    const btVector3 on_a = point.on_b + found.normal * point.distance;
    CachedPoint& now = pair.points[i];
    now.on_a = from_bullet(a.pose.invXform(a.moves ? on_a : on_a + point.offset_when_met));
    now.on_b =
        from_bullet(b.pose.invXform(a.moves ? point.on_b + point.offset_when_met : point.on_b));
    now.point = from_bullet(!b.moves ? on_a : !a.moves ? point.on_b : (point.on_b + on_a) / 2);
    now.gap = point.distance;
    now.impulse.setZero();
    now.angular_impulse.setZero();
    now.carried = false;
    int nearest = -1;
    double least = same;
    for (int j = 0; j < old_count; ++j) {
      const double away = std::min({squared_distance(old[j].on_a, now.on_a),
                                    squared_distance(old[j].on_b, now.on_b),
                                    squared_distance(old[j].point + with_a, now.point),
                                    squared_distance(old[j].point + with_b, now.point)});
      if (!taken[j] && away < least) least = away, nearest = j;
    }
    if (nearest >= 0) {
      taken[nearest] = true;
      now.impulse = old[nearest].impulse;
      now.angular_impulse = old[nearest].angular_impulse;
      now.carried = old[nearest].carried;
    }
  }
}

/// Appends the contacts of a pair's points to the list.
void ContactCache::append_contacts(const CachedPair& pair) {
  check_contact_points(contacts_.size());
  if (pair.count == 0) return;
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const dynamics::ContactPoint law = contact_of(a, b, pair.normal, pair.count);
  const std::size_t count = static_cast<std::size_t>(pair.count), next = contacts_.size() + ahead;
  if (next + count <= contacts_.capacity())
    dynamics::prefetch(contacts_.data() + next, count * sizeof(dynamics::ContactPoint));
  for (int i = 0; i < pair.count; ++i) {
    dynamics::ContactPoint& contact = contacts_.emplace_back(law);
    contact.point = pair.points[i].point;
    contact.gap = pair.points[i].gap;
    if (a.moves && b.moves) {
      set_contact_points(a, pair.points[i].on_a, b, pair.points[i].on_b, together_gap_, contact);
      set_point_velocity(a, b, time_step_, contact);
    }
    contact.carried = force_share_ > 0 && pair.points[i].carried;
    contact.impulse = force_share_ * pair.points[i].impulse;
    contact.angular_impulse = force_share_ * pair.points[i].angular_impulse;
    cache_indices_.push_back({static_cast<int>(&pair - pairs_.data()), i});
  }
}

}  // namespace ziggurat::physics
