// SPDX-License-Identifier: MIT
#include "physics/collision/contact_cache.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
  const double x = a.x() - b.x(), y = a.y() - b.y(), z = a.z() - b.z();
  return x * x + y * y + z * z;
}

/// Whether all of a collider stays above the floor, beyond its reach.
bool stays_above_floor(const Collider& collider) {
  constexpr btScalar rounding = btScalar(1e-9);  // [m]
  const btScalar extent = collider.pose.getBasis()[2].absolute().dot(collider.half_extents);
  return collider.pose.getOrigin().z() - extent > collider.reach + rounding;
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
  std::swap(listed_, listed_before_);
  collide_pairs(time_step);
  for (const ListedPair& before : listed_before_) {  // pairs that came apart in this part
    if (pairs_[before.pair].last_part != part_) pairs_[before.pair].count = 0;
  }
  drop_internal_edges();
  return contacts_;
}

void ContactCache::set_team(dynamics::Team* team) {
  previous_points_.resize(team ? team->size() : 1);
  team_ = team;
}

/// Lists all near pairs, and those with the floor.
void ContactCache::list_pairs() {
  listed_.clear();
  floor_pairs_.resize(colliders_.all.size(), 0);
  pairs_of_collider_.resize(colliders_.all.size());
  const std::size_t most_on_floor = colliders_.floor ? colliders_.all.size() : 0;
  if (pairs_.empty()) pairs_.reserve(1 + near_pairs_.size() + most_on_floor);
  for (const ColliderPair& near : near_pairs_) {
    listed_.emplace_back().pair = place_of(near.a, near.b, places_[key_of(near.a, near.b)]);
  }
  if (!colliders_.floor) return;
  for (const std::size_t index : colliders_.updated_groups()) {
    const ColliderGroup& group = colliders_.groups[index];
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      if (!colliders_.is_near_floor(i)) continue;
      listed_.emplace_back().pair = place_of(i, *colliders_.floor, floor_pairs_[i]);
    }
  }
}

/// Notes a pair that is to be collided.
void ContactCache::begin_pair(ListedPair& listed) {
  CachedPair& pair = pairs_[listed.pair];
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  if (pair.last_substep != substep_) pair.earlier_impulse.setZero();
  pair.last_substep = substep_;
  pair.last_part = part_;
  pair.covers_internal_edge = false;
  listed.rested = pair.is_static;
  listed.rests = pair.is_static = colliders_.is_static(a) && colliders_.is_static(b);
  listed.has_static_side = !(a.moves && b.moves);
}

/// Collides all near pairs, and those with the floor. Threads share them, and then write their
/// contacts, whose places follow from the counts of the pairs before.
void ContactCache::collide_pairs(double time_step) {
  constexpr std::size_t block = 32;  // pairs that a thread takes at once
  ++part_;
  time_step_ = time_step;
  slack_ = speculative_margin(colliders_, time_step);
  rotations_until_impact.clear();
  list_pairs();
  awake_ = 0;
  contact_count_ = 0;
  const std::size_t count = listed_.size();
  if (!team_) {
    for (std::size_t i = 0; i < count; ++i) {
      collide_pair(i, previous_points_.front());
      place_contacts(listed_[i]);
      if (contacts_.size() < contact_count_) contacts_.resize(contact_count_);
      write_contacts(listed_[i]);
    }
    contacts_.resize(contact_count_);
  } else {
    dynamics::share_in_blocks(team_, count, block, [&](std::size_t i, unsigned member) {
      collide_pair(i, previous_points_[member]);
    });
    for (ListedPair& listed : listed_) place_contacts(listed);
    contacts_.resize(contact_count_);
    dynamics::share_in_blocks(team_, count, block,
                              [&](std::size_t i, unsigned) { write_contacts(listed_[i]); });
  }
  list_supports();
}

std::span<dynamics::ContactPoint> ContactCache::add_resting_contacts() {
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    CachedPair& pair = pairs_[i];
    if (!pair.live || pair.last_substep == substep_ || pair.count == 0) continue;
    ListedPair& listed = listed_.emplace_back();
    listed.pair = static_cast<int>(i);
    listed.count = pair.count;
    listed.rested = listed.rests = true;
    place_contacts(listed);
    contacts_.resize(contact_count_);
    write_contacts(listed);
  }
  return contacts_;
}

void ContactCache::begin_parts(const TreeSet& active) {
  listed_.clear();
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    if (pairs_[i].count > 0 && both_active(pairs_[i].a, pairs_[i].b, colliders_, active))
      listed_.emplace_back().pair = static_cast<int>(i);
  }
}

std::span<dynamics::ContactPoint> ContactCache::keep_contacts(const TreeSet& active) {
  keep_if([&](const CachedPair& pair) { return both_active(pair.a, pair.b, colliders_, active); });
  for (ListedPair& listed : listed_) {
    if (!both_active(pairs_[listed.pair].a, pairs_[listed.pair].b, colliders_, active))
      listed.has_static_side = false;
  }
  return contacts_;
}

/// Collides a listed pair. It changes nothing of other pairs.
/// @param memory  of the thread
void ContactCache::collide_pair(std::size_t index, Points& memory) {
  constexpr std::size_t later = 4;
  if (index + later < listed_.size())
    dynamics::prefetch(&pairs_[listed_[index + later].pair], CachedPair::prefetched_bytes);
  ListedPair& listed = listed_[index];
  begin_pair(listed);
  CachedPair& pair = pairs_[listed.pair];
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const bool has_predictions = !colliders_.predicted.empty();
  if (pair.b == colliders_.floor && !has_predictions && stays_above_floor(a)) {
    pair.count = 0;
  } else {
    contact::Manifold found = collide(a, b, time_step_, slack_, most_points, listed.rotation);
    if (found.count == 0 && has_predictions) {
      found = collide_predicted(colliders_, pair.a, pair.b, time_step_, slack_, most_points,
                                listed.rotation);
    }
    match_points(found, pair, memory);
  }
  listed.count = pair.count;
  listed.has_no_contact = pair.count == 0;
}

/// Gives a pair's contacts their places, behind those of the pairs before it.
void ContactCache::place_contacts(ListedPair& listed) {
  resting_ += listed.rests;
  resting_ -= listed.rested;
  awake_ += !listed.rests;
  listed.first = static_cast<int>(contact_count_);
  contact_count_ += static_cast<std::size_t>(listed.count);
  check_contact_points(contact_count_);
  if (listed.rotation.rotation_until_impact == 0) return;
  const Collider& a = colliders_.all[pairs_[listed.pair].a];
  const Collider& b = colliders_.all[pairs_[listed.pair].b];
  rotations_until_impact.push_back({static_cast<int>((a.is_on_fixed_base ? a : b).entity),
                                    listed.rotation.rotation_until_impact});
}

/// Matches new points with those of the last substep, whose impulses they keep. The nearest point
/// counts: on either body, or moved with one.
/// @param old  memory
void ContactCache::match_points(const contact::Manifold& found, CachedPair& pair, Points& old) {
  constexpr double same = 25e-6;  // points more than 5 mm apart differ [m^2]
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const int old_count = std::exchange(pair.count, found.count);
  if (found.count == 0) return;
  for (int i = 0; i < old_count; ++i) old[i] = pair.points[i];
  pair.points.make_room(found.count);
  std::array<bool, most_points> taken{};
  // The contact point of a rolling body moves with that body's centre.
  const math::Vector3 with_a = time_step_ * from_bullet(a.velocity),
                      with_b = time_step_ * from_bullet(b.velocity);
  pair.normal = from_bullet(found.normal);
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
      if (taken[j]) continue;
      const double away = std::min({squared_distance(old[j].on_a, now.on_a),
                                    squared_distance(old[j].on_b, now.on_b),
                                    squared_distance(old[j].point + with_a, now.point),
                                    squared_distance(old[j].point + with_b, now.point)});
      if (away < least) least = away, nearest = j;
    }
    if (nearest >= 0) {
      taken[nearest] = true;
      now.impulse = old[nearest].impulse;
      now.angular_impulse = old[nearest].angular_impulse;
      now.carried = old[nearest].carried;
    }
  }
}

/// Writes the contacts of a pair's points to their places. It changes nothing of other pairs.
void ContactCache::write_contacts(const ListedPair& listed) {
  if (listed.count == 0) return;
  const CachedPair& pair = pairs_[listed.pair];
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const dynamics::ContactPoint law = contact_of(a, b, pair.normal, pair.count);
  for (int i = 0; i < listed.count; ++i) {
    dynamics::ContactPoint& contact = contacts_[listed.first + i];
    contact = law;
    contact.point = pair.points[i].point;
    contact.gap = pair.points[i].gap;
    if (a.moves && b.moves) {
      set_contact_points(a, pair.points[i].on_a, b, pair.points[i].on_b, together_gap_, contact);
      set_point_velocity(a, b, time_step_, contact);
    }
    contact.carried = force_share_ > 0 && pair.points[i].carried;
    contact.impulse = force_share_ * pair.points[i].impulse;
    contact.angular_impulse = force_share_ * pair.points[i].angular_impulse;
  }
}

}  // namespace ziggurat::physics
