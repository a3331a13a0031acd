// SPDX-License-Identifier: MIT
// Collides two colliders, with the motions that they have in a substep.

#include "physics/collision/collide.h"

#include <algorithm>
#include <vector>

namespace ziggurat::physics {
namespace {

btVector3 velocity_at(const Collider& collider, const btVector3& point) {
  return collider.velocity + collider.angular_velocity.cross(point - collider.pose.getOrigin());
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

}  // namespace

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

}  // namespace ziggurat::physics
