// SPDX-License-Identifier: MIT
#include <LinearMath/btTransformUtil.h>

#include <algorithm>

#include "physics/bodies/convert.h"
#include "physics/collision/colliders.h"
#include "physics/multibody/rotation.h"

namespace ziggurat::physics {
namespace {

bool is_round(const Collider& collider) {
  return std::holds_alternative<contact::Sphere>(collider.shape) ||
         std::holds_alternative<contact::Cylinder>(collider.shape) ||
         std::holds_alternative<contact::Capsule>(collider.shape);
}

/// Angular velocity of a collider's surface [rad/s], without rotation about its axis of symmetry.
/// The points of a spinning ball would be carried back to its side or its top.
btVector3 surface_angular_velocity(const Collider& collider) {
  if (std::holds_alternative<contact::Sphere>(collider.shape)) return {0, 0, 0};
  const btVector3& turning = collider.angular_velocity;
  if (!is_round(collider)) return turning;
  const btVector3 axis = collider.pose.getBasis().getColumn(2);
  return turning - axis * axis.dot(turning);
}

/// Pose of a collider's surface after some time. On a fixed base it continues its screw motion.
btTransform pose_after(const Collider& collider, double time) {
  if (!collider.moves) return collider.pose;
  const math::Quaternion turn =
      dynamics::exponential(from_bullet(surface_angular_velocity(collider)) * time);
  btVector3 way = collider.velocity * time;
  const btVector3& w = collider.angular_velocity;
  if (arm_rotation(collider, time) > 0) {
    const btVector3 to_axis = w.cross(collider.velocity) / w.length2();
    const btMatrix3x3 turned(to_bullet(dynamics::exponential(from_bullet(w) * time)));
    way = to_axis - turned * to_axis + w * (w.dot(collider.velocity) / w.length2() * time);
  }
  return btTransform(btMatrix3x3(to_bullet(turn)) * collider.pose.getBasis(),
                     collider.pose.getOrigin() + way);
}

/// Fastest approach of two surfaces along a normal from b to a, also later in a screw motion [m/s].
double fastest_approach(const Collider& a, const Collider& b, const btVector3& normal) {
  const auto centre = [](const Collider& collider, const btVector3& towards) {
    return collider.is_on_fixed_base ? collider.velocity.length() : towards.dot(collider.velocity);
  };
  return centre(b, normal) + centre(a, -normal) +
         surface_angular_velocity(a).cross(normal).length() * a.radius +
         surface_angular_velocity(b).cross(normal).length() * b.radius;
}

double least_distance(const contact::Manifold& found) {
  double least = BT_LARGE_FLOAT;
  for (int i = 0; i < found.count; ++i) least = std::min(least, double(found.points[i].distance));
  return least;
}

/// A collider, and its pose at an impact.
struct ColliderAtImpact {
  const Collider& collider;
  const btTransform& pose_at_impact;

  /// A point of its surface at its present position.
  btVector3 point_now(const btVector3& point) const {
    return collider.pose * pose_at_impact.invXform(point);
  }
  /// A point with the lever that it has at the impact.
  btVector3 point_with_impact_lever(const btVector3& point) const {
    return point - pose_at_impact.getOrigin() + collider.pose.getOrigin();
  }
  /// The velocity of a point at the impact.
  btVector3 velocity(const btVector3& point) const {
    return collider.velocity + collider.angular_velocity.cross(point - pose_at_impact.getOrigin());
  }
};

/// Carries points of the impact back to the present poses. Rebounds keep the levers of the touch,
/// and their distance is that of their closing velocity over the time.
/// @param time  until then [s]
void carry_points_back(contact::Manifold& found, const ColliderAtImpact& a,
                       const ColliderAtImpact& b, double time) {
  const bool turned = rebounds_at_touch_pose(a.collider, b.collider);
  for (int i = 0; i < found.count; ++i) {
    contact::ManifoldPoint& point = found.points[i];
    const btVector3 then_a = point.on_b + found.normal * point.distance, then_b = point.on_b;
    const btVector3 on_a = turned ? a.point_with_impact_lever(then_a) : a.point_now(then_a),
                    on_b = turned ? b.point_with_impact_lever(then_b) : b.point_now(then_b);
    point.distance =
        turned ? point.distance - time * found.normal.dot(a.velocity(then_a) - b.velocity(then_b))
               : found.normal.dot(on_a - on_b);
    // Opposite the point of the moving body, or of the first one.
    point.on_b = a.collider.moves ? on_a - found.normal * point.distance : on_b;
    point.offset_when_met =
        a.collider.moves ? on_b - point.on_b : on_a - (on_b + found.normal * point.distance);
  }
}

}  // namespace

bool has_rotating_normal(const Collider& a, const Collider& b) {
  const auto is_plane = [](const Collider& c) {
    return std::holds_alternative<contact::HalfSpace>(c.shape);
  };
  return (is_round(a) || is_round(b)) && !is_plane(a) && !is_plane(b);
}

bool rebounds_at_touch_pose(const Collider& a, const Collider& b) {
  const auto is_alone = [](const Collider& collider) {
    return collider.is_single_body || !collider.moves;
  };
  return std::max(a.surface.restitution, b.surface.restitution) > 0 && is_alone(a) && is_alone(b);
}

double arm_rotation(const Collider& collider, double time) {
  constexpr double on_axis = 1e-3;  // of its size: a centre so near the axis only rotates
  if (!collider.is_on_fixed_base) return 0;
  const double turning = collider.angular_velocity.length();
  return time * (collider.velocity.length() > on_axis * turning * collider.radius
                     ? turning
                     : double(surface_angular_velocity(collider).length()));
}

contact::Manifold time_of_impact(const Collider& a, const Collider& b, double time_step,
                                 double near, double& time) {
  constexpr int most_steps = 256;  // for bodies that rotate much faster than they approach
  constexpr int most_near = 12;    // steps that follow to the touch, below `near`
  constexpr double touch = 1e-7;   // [m]
  int left = has_rotating_normal(a, b) || rebounds_at_touch_pose(a, b) ? most_near : 0;
  contact::Manifold met;
  double now = time = 0;
  for (int step = 0; step < most_steps; ++step) {
    const btTransform pose_a = pose_after(a, now), pose_b = pose_after(b, now);
    contact::Manifold found =
        contact::find(a.shape, pose_a, b.shape, pose_b, a.reach + b.reach, contact::Support::all);
    const double distance = least_distance(found);
    if (found.count == 0) return met;  // out of reach
    const double approach = fastest_approach(a, b, found.normal);
    const double follow = left > 0 ? touch : near;
    if (distance <= near ||
        met.count > 0) {  // also after they have passed each other: the normal shows it
      met = found;
      time = now;
      carry_points_back(met, {a, pose_a}, {b, pose_b}, now);
      if (distance <= touch || --left <= 0) break;
    }
    if (approach <= 0) break;
    const double next = now + (distance - follow / 2) / approach;
    const bool ends_near = distance - approach * (time_step - now) <=
                           near;  // gravity may bring them together where their speeds do not
    if (next >= time_step && (met.count > 0 || !ends_near)) break;
    now = std::min(next, time_step);
  }
  return met;
}

}  // namespace ziggurat::physics
