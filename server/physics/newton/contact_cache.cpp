#include "physics/newton/contact_cache.h"

#include <algorithm>
#include <cmath>

#include "dynamics/prefetch.h"
#include "physics/convert.h"
#include "physics/contact_limits.h"
#include "physics/newton/time_of_impact.h"

namespace ziggurat::physics {
namespace {

/// The other links of an entity that stands are a part of the world, too.
dynamics::LinkIndex link_of(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {static_cast<int>(collider.entity), static_cast<int>(collider.part)};
}

ContactSide side(const Collider& collider) {
  if (collider.entity == Collider::floor) return {};
  return {collider.entity, collider.link};
}

btVector3 velocity_at(const Collider& collider, const btVector3& point) {
  return collider.velocity + collider.angular_velocity.cross(point - collider.pose.getOrigin());
}

/// Whether a contact is one of a wheeled body's lower or upper face.
bool rolls_on(const Collider& collider, const btVector3& normal) {
  constexpr btScalar face = btScalar(0.7);  // cosine of the steepest such contact
  return collider.rolls && btFabs(collider.pose.getBasis().getColumn(2).dot(normal)) > face;
}

double square_between(const math::Vector3& a, const math::Vector3& b) {
  return (to_bullet(a) - to_bullet(b)).length2();
}

/// How two colliders come together in a substep.
struct Approach {
  double least = BT_LARGE_FLOAT;  ///< distance of all points [m]
  double fastest = 0;             ///< speed at which points close [m/s]
  bool may_touch = false;         ///< a point is close, or comes so
};

/// @param slack  what counts as close [m]
Approach approach_of(const contact::Contacts& found, const Collider& a, const Collider& b,
                     double length, double slack) {
  Approach out;
  for (int i = 0; i < found.count; ++i) {
    const contact::Point& point = found.points[i];
    const double speed = found.normal.dot(velocity_at(b, point.on_b) - velocity_at(a, point.on_b));
    out.least = std::min(out.least, double(point.distance));
    out.fastest = std::max(out.fastest, speed);
    out.may_touch |= point.distance <= slack + length * std::max(0.0, speed);
  }
  return out;
}

/// A bound of the distances at which points may come close, see approach_of(): from the fastest
/// that the surfaces can approach each other. Radii are larger than they are, because points may
/// lie a little outside [m].
double farthest_that_may_touch(const Collider& a, const Collider& b, double length, double slack) {
  constexpr double larger = 1.5;
  const double arm = larger * a.radius + a.reach + b.reach;  // from a to points on b
  const double speed = (b.velocity - a.velocity).length() + a.angular_velocity.length() * arm +
                       b.angular_velocity.length() * larger * b.radius;
  return slack + length * speed;
}

/// Half of it; the floor has none [m].
double smallest_extent(const Collider& collider) {
  if (collider.entity == Collider::floor) return BT_LARGE_FLOAT;
  return std::min({collider.half.x(), collider.half.y(), collider.half.z()});
}

/// Whether a body may turn so far in a substep that another side of it lands: it turns, or an
/// impact turns it.
bool tumbles(const Collider& a, const Collider& b, const Approach& approach, double length) {
  constexpr double far = 0.05;  // [rad]
  const double turning = (a.angular_velocity - b.angular_velocity).length();
  return length * (turning + approach.fastest / std::min(smallest_extent(a), smallest_extent(b))) >
         far;
}

/// Where two colliders that move touch, see dynamics::Contact. What is apart meets later in the substep, each with its own point.
/// @param on_a, on_b  in the colliders' frames [m]
/// @param apart       closer surfaces count as together [m]
void place_between(const Collider& a, const math::Vector3& on_a, const Collider& b, const math::Vector3& on_b,
                   double apart, dynamics::ContactPoint& contact) {
  const math::Vector3 from = from_bullet(a.pose * to_bullet(on_a)), way = from_bullet(b.pose * to_bullet(on_b)) - from;
  if (way.squaredNorm() < dynamics::touching_gap * dynamics::touching_gap) return;
  if (contact.gap > apart) {
    contact.point = from;
    contact.offset_to_b = way;
  } else {
    contact.offset_to_b = way - way.dot(contact.normal) * contact.normal;
  }
}

/// Whether a collider touches with a round surface, so that its point of contact is not always the same.
bool is_round(const Collider& collider, const btVector3& normal) {
  constexpr btScalar upright = btScalar(0.7);  // cosine of the steepest axis of what lies on its side
  const auto lies = [&] { return btFabs(collider.pose.getBasis().getColumn(2).dot(normal)) < upright; };
  return std::holds_alternative<contact::Sphere>(collider.shape) ||
         ((std::holds_alternative<contact::Cylinder>(collider.shape) || std::holds_alternative<contact::Capsule>(collider.shape)) && lies());
}

/// Notes how the point of contact moves where one of two colliders that move is round and the other one is not: with its centre,
/// and as the other one's face turns; about the normal as it turns itself, unless that turns it far in the substep.
void note_rolling(const Collider& a, const Collider& b, double length, dynamics::ContactPoint& contact) {
  constexpr double far = 0.2;  // [rad]
  const btVector3 normal = to_bullet(contact.normal);
  const bool round_a = is_round(a, normal);
  if (round_a == is_round(b, normal)) return;
  const Collider& round = round_a ? a : b;
  const btVector3 arm = to_bullet(round_a ? contact.point : math::Vector3(contact.point + contact.offset_to_b)) - round.pose.getOrigin();
  const btScalar turning = round.angular_velocity.dot(normal);
  const bool is_ball = std::holds_alternative<contact::Sphere>(round.shape);
  if (!is_ball && length * btFabs(turning) > far) return;
  contact.has_point_velocity = true;
  const btVector3 face_turning = (round_a ? b : a).angular_velocity, tilt = face_turning.cross(normal) * arm.dot(normal);
  contact.face_angular_velocity = from_bullet(face_turning);
  contact.point_velocity = from_bullet(is_ball ? round.velocity + tilt : round.velocity + tilt + turning * normal.cross(arm));
}

/// Whether a body that seems to pass what stands may yet come there, because the ways of what turns are bent, and its axis turns, too: each changes
/// a way by up to r (w h)^2 / 2.
/// @param slack  what counts as close [m]
bool may_turn_into(const Collider& a, const Collider& b, double length, double slack) {
  constexpr double far = 0.05;  // [rad]
  if (a.moves && b.moves) return false;
  const Collider& moving = a.moves ? a : b;
  const double turn = length * moving.angular_velocity.length();
  if (turn < far) return false;
  const double bend = moving.radius * turn * turn;
  const contact::Contacts all = contact::find(a.shape, a.pose, b.shape, b.pose, a.reach + b.reach, contact::Support::all);
  for (int i = 0; i < all.count; ++i) {
    const contact::Point& point = all.points[i];
    const double speed = all.normal.dot(velocity_at(b, point.on_b) - velocity_at(a, point.on_b));
    if (point.distance - length * speed <= slack + bend) return true;
  }
  return false;
}

/// How two colliders turn in a substep.
struct Turning {
  bool tumbles = false;  ///< one so far that other points may touch
  bool may_land = false;  ///< nothing touches, but points may come to overlap as one turns
  double swing = 0;      ///< one that swings, until they meet [rad]
};

/// The points of two colliders that may touch within the substep.
/// @param slack        what counts as close [m]
/// @param most_points  of those that tumble
contact::Contacts look(const Collider& a, const Collider& b, double length, double slack, int most_points, Turning& out) {
  constexpr double far = 0.2;  // a swing whose way bends [rad]
  const double reach = a.reach + b.reach;
  contact::Contacts found =
      contact::find(a.shape, a.pose, b.shape, b.pose, reach, contact::Support::face,
                    farthest_that_may_touch(a, b, length, slack));
  const Approach approach = approach_of(found, a, b, length, slack);
  const bool in_reach = found.count > 0;
  out.tumbles = approach.may_touch && tumbles(a, b, approach, length);
  const bool swings = found.count > 0 && std::max(swing_of(a, length), swing_of(b, length)) > far;
  double time = 0;
  if (approach.least > slack && (swings || approach.may_touch)) {
    found = first_meeting(a, b, length, slack / 2, time);
    if (found.count > 0 && swings) out.swing = std::max(swing_of(a, time), swing_of(b, time));
  } else if (!approach.may_touch) {
    found.count = 0;
  } else if (found.count <= 2 && approach.least > dynamics::touching_gap && (normal_turns(a, b) || rebound_turned(a, b))) {
    found = first_meeting(a, b, length, slack, time);
  } else if (out.tumbles) {
    found = contact::find(a.shape, a.pose, b.shape, b.pose, reach, contact::Support::all);
  }
  out.may_land = found.count == 0 && in_reach && may_turn_into(a, b, length, slack);
  if (!out.tumbles || found.count > most_points) contact::reduce(found, (a.moves ? a : b).pose);
  return found;
}

/// The points where two colliders may touch as something throws them within the substep.
contact::Contacts look_at_thrown(const Colliders& colliders, std::size_t a, std::size_t b, double length, double slack, int most_points,
                                 Turning& out) {
  const auto ways_of = [&](std::size_t index) {
    std::vector<const Collider*> ways{&colliders.all[index]};
    for (const Colliders::Thrown& thrown : colliders.thrown) {
      if (thrown.index == index) ways.push_back(&thrown.collider);
    }
    return ways;
  };
  const auto of_a = ways_of(a), of_b = ways_of(b);
  for (const Collider* way_a : of_a) {
    for (const Collider* way_b : of_b) {
      if (way_a == of_a[0] && way_b == of_b[0]) continue;
      const contact::Contacts found = look(*way_a, *way_b, length, slack, most_points, out);
      if (found.count > 0) return found;
    }
  }
  return {};
}

/// Whether each of two colliders is chosen, or stands.
bool is_among(std::size_t a, std::size_t b, const Colliders& colliders, const TreeSet& chosen) {
  const auto counts = [&](const Collider& collider) { return !collider.moves || chosen.holds[collider.entity]; };
  return counts(colliders.all[a]) && counts(colliders.all[b]);
}

}  // namespace

dynamics::ContactPoint law_of(const Collider& a, const Collider& b, const math::Vector3& normal,
                         int count) {
  const bool rolls = rolls_on(a, to_bullet(normal)) || rolls_on(b, to_bullet(normal));
  dynamics::ContactPoint law;
  law.a = link_of(a);
  law.b = link_of(b);
  law.normal = normal;
  law.friction = rolls ? 0 : a.surface.friction * b.surface.friction;
  // Only a point or a line of contact can roll; each carries its share of the normal force.
  if (count <= 2) {
    law.rolling_friction = a.surface.rolling_friction + b.surface.rolling_friction;
    law.spinning_friction = a.surface.spinning_friction + b.surface.spinning_friction;
  }
  law.restitution = std::max(a.surface.restitution, b.surface.restitution);
  return law;
}

std::span<dynamics::ContactPoint> Contacts::find(double length) {
  ++substep_;
  share_ = 1;
  apart_ = dynamics::restitution_threshold * length;
  colliders_.find_near(near_);
  meet_all(length);
  if (colliders_.woke || awake_ + resting_ != live_) drop_unseen();
  drop_hidden();
  return contacts_;
}

std::span<dynamics::ContactPoint> Contacts::find(double length, const TreeSet& chosen, double share) {
  share_ = share;
  apart_ = HUGE_VAL;  // parts are short, and magnets' bonds ask for all of the angular momentum
  colliders_.find_near(near_, chosen);
  std::swap(met_, met_before_);
  meet_all(length);
  for (const int number : met_before_) {  // what came apart in this part of the substep
    if (pairs_[number].met != part_) pairs_[number].count = 0;
  }
  drop_hidden();
  return contacts_;
}

/// All pairs that are near, and those with the floor.
void Contacts::meet_all(double length) {
  ++part_;
  length_ = length;
  swings.clear();
  contacts_.clear();
  owners_.clear();
  turned_.clear();
  met_.clear();
  on_bases_.clear();
  awake_ = 0;
  floor_pairs_.resize(colliders_.all.size(), 0);
  lists_.resize(colliders_.all.size());
  for (const Near& near : near_) {
    meet(pair_of(near.a, near.b, places_[key_of(near.a, near.b)]), length);
  }
  if (!colliders_.floor) return;
  const std::span<const std::size_t> followed = colliders_.followed();
  for (std::size_t k = 0; k < followed.size(); ++k) {
    const ColliderGroup& group = colliders_.groups[followed[k]];
    const ColliderGroup& next = colliders_.groups[followed[std::min(k + 1, followed.size() - 1)]];
    for (std::size_t i = next.first; i < next.first + next.count; ++i) {
      if (floor_pairs_[i] != 0) dynamics::prefetch(&pairs_[floor_pairs_[i]], Pair::beginning);
    }
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const Collider& collider = colliders_.all[i];
      if (collider.pose.getOrigin().z() > collider.radius + collider.reach) continue;
      meet(pair_of(i, *colliders_.floor, floor_pairs_[i]), length);
    }
  }
}

std::span<dynamics::ContactPoint> Contacts::add_resting() {
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    if (!pair.live || pair.seen == substep_) continue;
    emit(pair);
  }
  return contacts_;
}

void Contacts::choose(const TreeSet& chosen) {
  met_.clear();
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    if (pairs_[i].count > 0 && is_among(pairs_[i].a, pairs_[i].b, colliders_, chosen)) met_.push_back(static_cast<int>(i));
  }
}

std::span<dynamics::ContactPoint> Contacts::keep(const TreeSet& chosen) {
  keep_if([&](const Pair& pair) { return is_among(pair.a, pair.b, colliders_, chosen); });
  std::erase_if(turned_, [&](const Turned& turned) { return !is_among(pairs_[turned.pair].a, pairs_[turned.pair].b, colliders_, chosen); });
  return contacts_;
}

void Contacts::meet(Pair& pair, double length) {
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  pair.met = part_;
  pair.covers = false;
  met_.push_back(static_cast<int>(&pair - pairs_.data()));
  resting_ -= pair.rests;
  pair.rests = colliders_.rests(a) && colliders_.rests(b);
  resting_ += pair.rests;
  awake_ += !pair.rests;
  Turning turning;
  const double slack = least_reach(colliders_, length);
  contact::Contacts found = look(a, b, length, slack, most_points, turning);
  if (found.count == 0 && !colliders_.thrown.empty()) {
    found = look_at_thrown(colliders_, pair.a, pair.b, length, slack, most_points, turning);
  }
  if (turning.swing > 0) swings.push_back({static_cast<int>((a.swings ? a : b).entity), turning.swing});
  add(found, pair, length);
  if (found.count > 0) note_bases(pair);
  if (a.moves && b.moves) return;
  turned_.push_back({static_cast<std::size_t>(&pair - pairs_.data()), found.count == 0, turning.may_land || turning.tumbles});
}

/// Appends the pair's contacts, each with the impulse of the point of the last substep that is
/// nearest: on either body, or moved with one.
/// @param length  [s]
void Contacts::add(const contact::Contacts& found, Pair& pair, double length) {
  constexpr double same = 25e-6;  // 5 mm apart is another contact [m^2]
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const int old_count = pair.count;
  auto& old = before_;
  std::copy_n(pair.points.begin(), old_count, old.begin());
  std::array<bool, most_points> taken{};
  // A point of what rolls moves with neither surface, but with the body that rolls.
  const math::Vector3 with_a = length * from_bullet(a.velocity), with_b = length * from_bullet(b.velocity);
  pair.count = found.count;
  if (found.count > 0) pair.normal = from_bullet(found.normal);
  for (int i = 0; i < found.count; ++i) {
    const contact::Point& point = found.points[i];
    const btVector3 on_a = point.on_b + found.normal * point.distance;
    Remembered& now = pair.points[i];
    now.on_a = from_bullet(a.pose.invXform(a.moves ? on_a : on_a + point.until_met));
    now.on_b = from_bullet(b.pose.invXform(a.moves ? point.on_b + point.until_met : point.on_b));
    now.point = from_bullet(!b.moves ? on_a : !a.moves ? point.on_b : (point.on_b + on_a) / 2);
    now.gap = point.distance;
    now.impulse.setZero();
    now.angular_impulse.setZero();
    int nearest = -1;
    double least = same;
    for (int j = 0; j < old_count; ++j) {
      const double away = std::min({square_between(old[j].on_a, now.on_a), square_between(old[j].on_b, now.on_b),
                                    square_between(old[j].point + with_a, now.point), square_between(old[j].point + with_b, now.point)});
      if (!taken[j] && away < least) least = away, nearest = j;
    }
    if (nearest >= 0) {
      taken[nearest] = true;
      now.impulse = old[nearest].impulse;
      now.angular_impulse = old[nearest].angular_impulse;
    }
  }
  emit(pair);
}

/// Appends the contacts of a pair's points to the list.
void Contacts::emit(const Pair& pair) {
  check_contact_points(contacts_.size());
  if (pair.count == 0) return;
  const Collider& a = colliders_.all[pair.a];
  const Collider& b = colliders_.all[pair.b];
  const dynamics::ContactPoint law = law_of(a, b, pair.normal, pair.count);
  const std::size_t count = static_cast<std::size_t>(pair.count), next = contacts_.size() + ahead;
  if (next + count <= contacts_.capacity()) dynamics::prefetch(contacts_.data() + next, count * sizeof(dynamics::ContactPoint));
  for (int i = 0; i < pair.count; ++i) {
    dynamics::ContactPoint& contact = contacts_.emplace_back(law);
    contact.point = pair.points[i].point;
    contact.gap = pair.points[i].gap;
    if (a.moves && b.moves) {
      place_between(a, pair.points[i].on_a, b, pair.points[i].on_b, apart_, contact);
      note_rolling(a, b, length_, contact);
    }
    contact.impulse = share_ * pair.points[i].impulse;
    contact.angular_impulse = share_ * pair.points[i].angular_impulse;
    owners_.push_back({static_cast<int>(&pair - pairs_.data()), i});
  }
}

void Contacts::remember(bool more) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (i + ahead < contacts_.size()) {
      const Owner& owner = owners_[i + ahead];
      const Pair& pair = pairs_[owner.pair];
      dynamics::prefetch(&contacts_[i + ahead].impulse, 2 * sizeof(math::Vector3));
      dynamics::prefetch(&pair.share, sizeof(pair.share));
      dynamics::prefetch(&pair.points[owner.point].impulse, 2 * sizeof(math::Vector3));
    }
    Pair& pair = pairs_[owners_[i].pair];
    Remembered& point = pair.points[owners_[i].point];
    if (more) pair.earlier += contacts_[i].impulse;
    if (share_ == 0) continue;
    point.impulse = contacts_[i].impulse / share_;
    point.angular_impulse = contacts_[i].angular_impulse / share_;
    pair.share = share_;
  }
}

void Contacts::tell(std::vector<Contact>& out) const {
  out.clear();
  for (const Pair& pair : pairs_) {
    math::Vector3 middle(0, 0, 0), sum = pair.earlier;
    int count = 0;
    for (int i = 0; i < pair.count; ++i) {
      const Remembered& point = pair.points[i];
      const bool pressed = point.impulse.dot(pair.normal) > 0 || !pair.earlier.isZero(0);
      if (!pressed && point.gap > 0) continue;
      middle += point.point;
      sum += pair.share * point.impulse;
      ++count;
    }
    const bool came_apart = pair.live && pair.count == 0 && pair.seen == substep_ && !pair.earlier.isZero(0);
    if (came_apart) middle = pair.points[0].point, count = 1;
    if (count == 0) continue;
    out.push_back(in_order({side(colliders_.all[pair.a]), side(colliders_.all[pair.b]), pair.normal,
                            middle / count, sum}));
  }
  sort(out);
}

}  // namespace ziggurat::physics
