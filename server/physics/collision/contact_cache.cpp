#include "physics/collision/contact_cache.h"

#include <algorithm>
#include <cmath>

#include "physics/bodies/convert.h"
#include "physics/collision/colliders.h"
#include "physics/collision/contact_limits.h"
#include "physics/multibody/prefetch.h"

namespace ziggurat::physics {
namespace {

/// Link of a collider in its tree. All links of an entity that stands are parts of the world.
dynamics::LinkIndex link_of(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {static_cast<int>(collider.entity), static_cast<int>(collider.part)};
}

btVector3 velocity_at(const Collider& collider, const btVector3& point) {
  return collider.velocity + collider.angular_velocity.cross(point - collider.pose.getOrigin());
}

/// Whether a contact is one of a wheeled body's lower or upper face.
bool is_wheel_contact(const Collider& collider, const btVector3& normal) {
  constexpr btScalar face = btScalar(0.7);  // cosine of the steepest such contact
  return collider.has_wheels && btFabs(collider.pose.getBasis().getColumn(2).dot(normal)) > face;
}

double squared_distance(const math::Vector3& a, const math::Vector3& b) {
  return (to_bullet(a) - to_bullet(b)).length2();
}

/// Approach of two colliders in a substep.
struct Approach {
  double least = BT_LARGE_FLOAT;  ///< distance of all points [m]
  double fastest = 0;             ///< speed at which points close [m/s]
  bool may_touch = false;         ///< a point is close, or comes so
};

/// @param slack  what counts as close [m]
Approach approach_of(const contact::Manifold& found, const Collider& a, const Collider& b,
                     double time_step, double slack) {
  Approach out;
  for (int i = 0; i < found.count; ++i) {
    const contact::ManifoldPoint& point = found.points[i];
    const double speed = found.normal.dot(velocity_at(b, point.on_b) - velocity_at(a, point.on_b));
    out.least = std::min(out.least, double(point.distance));
    out.fastest = std::max(out.fastest, speed);
    out.may_touch |= point.distance <= slack + time_step * std::max(0.0, speed);
  }
  return out;
}

/// Bound of the distances at which points may come close, see approach_of(): from the fastest
/// possible approach of the surfaces. Radii are enlarged, because points may lie a little outside
/// [m].
double most_distance_to_touch(const Collider& a, const Collider& b, double time_step,
                              double slack) {
  constexpr double larger = 1.5;
  const double arm = larger * a.radius + a.reach + b.reach;  // from a to points on b
  const double speed = (b.velocity - a.velocity).length() + a.angular_velocity.length() * arm +
                       b.angular_velocity.length() * larger * b.radius;
  return slack + time_step * speed;
}

/// Smallest half extent; the floor has none [m].
double smallest_extent(const Collider& collider) {
  if (collider.entity == Collider::floor) return BT_LARGE_FLOAT;
  return std::min(
      {collider.half_extents.x(), collider.half_extents.y(), collider.half_extents.z()});
}

/// Whether a body may rotate so far in a substep, by itself or by an impact, that another side of
/// it lands.
bool tumbles(const Collider& a, const Collider& b, const Approach& approach, double time_step) {
  constexpr double far = 0.05;  // [rad]
  const double turning = (a.angular_velocity - b.angular_velocity).length();
  return time_step *
             (turning + approach.fastest / std::min(smallest_extent(a), smallest_extent(b))) >
         far;
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

/// Whether a body that seems to pass a static one may still reach it. Rotation curves its path and
/// turns its axis: each changes the path by up to r (w h)^2 / 2.
/// @param slack  gap that counts as close [m]
bool may_rotate_into(const Collider& a, const Collider& b, double time_step, double slack) {
  constexpr double far = 0.05;  // [rad]
  if (a.moves && b.moves) return false;
  const Collider& moving = a.moves ? a : b;
  const double turn = time_step * moving.angular_velocity.length();
  if (turn < far) return false;
  const double bend = moving.radius * turn * turn;
  const contact::Manifold all =
      contact::find(a.shape, a.pose, b.shape, b.pose, a.reach + b.reach, contact::Support::all);
  for (int i = 0; i < all.count; ++i) {
    const contact::ManifoldPoint& point = all.points[i];
    const double speed = all.normal.dot(velocity_at(b, point.on_b) - velocity_at(a, point.on_b));
    if (point.distance - time_step * speed <= slack + bend) return true;
  }
  return false;
}

/// Rotation of two colliders in a substep.
struct RotationOutcome {
  bool tumbles = false;              ///< one so far that other points may touch
  bool may_overlap = false;          ///< no contact, but rotation may bring one
  double rotation_until_impact = 0;  ///< of one on a fixed base, until the impact [rad]
};

/// Collides two colliders: points that may touch within the substep.
/// @param slack        gap that counts as close [m]
/// @param most_points  of those that tumble
contact::Manifold collide(const Collider& a, const Collider& b, double time_step, double slack,
                          int most_points, RotationOutcome& out) {
  constexpr double far = 0.2;  // rotation whose path is curved [rad]
  const double reach = a.reach + b.reach;
  contact::Manifold found =
      contact::find(a.shape, a.pose, b.shape, b.pose, reach, contact::Support::face,
                    most_distance_to_touch(a, b, time_step, slack));
  const Approach approach = approach_of(found, a, b, time_step, slack);
  const bool in_reach = found.count > 0;
  out.tumbles = approach.may_touch && tumbles(a, b, approach, time_step);
  const bool swings =
      found.count > 0 && std::max(arm_rotation(a, time_step), arm_rotation(b, time_step)) > far;
  double time = 0;
  if (approach.least > slack && (swings || approach.may_touch)) {
    found = time_of_impact(a, b, time_step, slack / 2, time);
    if (found.count > 0 && swings)
      out.rotation_until_impact = std::max(arm_rotation(a, time), arm_rotation(b, time));
  } else if (!approach.may_touch) {
    found.count = 0;
  } else if (found.count <= 2 && approach.least > dynamics::touching_gap &&
             (has_rotating_normal(a, b) || rebounds_at_touch_pose(a, b))) {
    found = time_of_impact(a, b, time_step, slack, time);
  } else if (out.tumbles) {
    found = contact::find(a.shape, a.pose, b.shape, b.pose, reach, contact::Support::all);
  }
  out.may_overlap = found.count == 0 && in_reach && may_rotate_into(a, b, time_step, slack);
  if (!out.tumbles || found.count > most_points) contact::reduce(found, (a.moves ? a : b).pose);
  return found;
}

/// Collides two colliders with their predicted motions.
contact::Manifold collide_predicted(const Colliders& colliders, std::size_t a, std::size_t b,
                                    double time_step, double slack, int most_points,
                                    RotationOutcome& out) {
  const auto ways_of = [&](std::size_t index) {
    std::vector<const Collider*> ways{&colliders.all[index]};
    for (const Colliders::PredictedCollider& thrown : colliders.predicted) {
      if (thrown.index == index) ways.push_back(&thrown.collider);
    }
    return ways;
  };
  const auto of_a = ways_of(a), of_b = ways_of(b);
  for (const Collider* way_a : of_a) {
    for (const Collider* way_b : of_b) {
      if (way_a == of_a[0] && way_b == of_b[0]) continue;
      const contact::Manifold found = collide(*way_a, *way_b, time_step, slack, most_points, out);
      if (found.count > 0) return found;
    }
  }
  return {};
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

/// Collides all near pairs, and those with the floor.
void ContactCache::collide_pairs(double time_step) {
  ++part_;
  time_step_ = time_step;
  rotations_until_impact.clear();
  contacts_.clear();
  cache_indices_.clear();
  overlap_candidates_.clear();
  pairs_of_part_.clear();
  supports_.clear();
  awake_ = 0;
  floor_pairs_.resize(colliders_.all.size(), 0);
  pairs_of_collider_.resize(colliders_.all.size());
  for (const ColliderPair& near : near_pairs_) {
    collide_pair(pair_of(near.a, near.b, places_[key_of(near.a, near.b)]), time_step);
  }
  if (!colliders_.floor) return;
  const std::span<const std::size_t> followed = colliders_.updated_groups();
  for (std::size_t k = 0; k < followed.size(); ++k) {
    const ColliderGroup& group = colliders_.groups[followed[k]];
    const ColliderGroup& next = colliders_.groups[followed[std::min(k + 1, followed.size() - 1)]];
    for (std::size_t i = next.first; i < next.first + next.count; ++i) {
      if (floor_pairs_[i] != 0)
        dynamics::prefetch(&pairs_[floor_pairs_[i]], CachedPair::prefetched_bytes);
    }
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const Collider& collider = colliders_.all[i];
      if (collider.pose.getOrigin().z() > collider.radius + collider.reach) continue;
      collide_pair(pair_of(i, *colliders_.floor, floor_pairs_[i]), time_step);
    }
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

void ContactCache::collide_pair(CachedPair& pair, double time_step) {
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  pair.last_part = part_;
  pair.covers_internal_edge = false;
  pairs_of_part_.push_back(static_cast<int>(&pair - pairs_.data()));
  resting_ -= pair.is_static;
  pair.is_static = colliders_.is_static(a) && colliders_.is_static(b);
  resting_ += pair.is_static;
  awake_ += !pair.is_static;
  RotationOutcome turning;
  const double slack = speculative_margin(colliders_, time_step);
  contact::Manifold found = collide(a, b, time_step, slack, most_points, turning);
  if (found.count == 0 && !colliders_.predicted.empty()) {
    found = collide_predicted(colliders_, pair.a, pair.b, time_step, slack, most_points, turning);
  }
  if (turning.rotation_until_impact > 0)
    rotations_until_impact.push_back(
        {static_cast<int>((a.is_on_fixed_base ? a : b).entity), turning.rotation_until_impact});
  match_points(found, pair, time_step);
  if (found.count > 0) list_supports(pair);
  if (a.moves && b.moves) return;
  overlap_candidates_.push_back({static_cast<std::size_t>(&pair - pairs_.data()), found.count == 0,
                                 turning.may_overlap || turning.tumbles});
}

/// Matches new points with those of the last substep, and appends the pair's contacts with their
/// impulses. The nearest point counts: on either body, or moved with one.
/// @param time_step  [s]
void ContactCache::match_points(const contact::Manifold& found, CachedPair& pair,
                                double time_step) {
  constexpr double same = 25e-6;  // points more than 5 mm apart differ [m^2]
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const int old_count = pair.count;
  auto& old = previous_points_;
  std::copy_n(pair.points.begin(), old_count, old.begin());
  std::array<bool, most_points> taken{};
  // The contact point of a rolling body moves with that body's centre.
  const math::Vector3 with_a = time_step * from_bullet(a.velocity),
                      with_b = time_step * from_bullet(b.velocity);
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
    }
  }
  append_contacts(pair);
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
    contact.impulse = force_share_ * pair.points[i].impulse;
    contact.angular_impulse = force_share_ * pair.points[i].angular_impulse;
    cache_indices_.push_back({static_cast<int>(&pair - pairs_.data()), i});
  }
}

}  // namespace ziggurat::physics
