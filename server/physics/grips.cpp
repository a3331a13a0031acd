// SPDX-License-Identifier: MIT
#include "physics/grips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/bodies/convert.h"
#include "physics/collision/shapes.h"

namespace ziggurat::physics {
namespace {

using math::Vector3;

/// A turret without front stands still in its robot.
double turret_angle(const Body& robot) { return robot.turret ? robot.turret->angle : 0; }

double turret_spin(const Body& robot) {
  return robot.turret && !robot.turret->follows ? robot.turret->speed : 0;
}

bool turns_freely(const Body& robot) { return robot.turret && robot.turret->follows; }

/// Frame of a grip in the world: its rows are outward, across and up; and the robot's centre.
struct GripFrame {
  math::Pose robot;  // X_WP
  Vector3 held;      // point that is held, in W [m]
  Vector3 seen;      // the same in P [m]
};

GripFrame frame_of(const Grip& grip, std::span<const Body> bodies) {
  const math::Pose robot = from_bullet(bodies[grip.entity].transform(std::size_t{0}));
  const Vector3 held = from_bullet(bodies[grip.held].transform(grip.part)) * grip.point;
  return {robot, held, math::inverse(robot) * held};
}

/// Upright cylinder of a gripper, in the world.
btTransform place_of(const Body& robot, const Gripper& gripper) {
  const double angle = turret_angle(robot);
  const math::Pose origin = from_bullet(robot.transform(std::size_t{0})) * robot.links[0].in_part *
                            math::inverse(robot.links[0].center) * robot.origin_from_reference;
  const Vector3 center(gripper.distance * std::cos(angle), gripper.distance * std::sin(angle),
                       gripper.height / 2);
  return to_bullet(origin * math::Pose{center, math::Quaternion::Identity()});
}

}  // namespace

std::optional<Grip> find_grip(const Body& robot, const Gripper& gripper,
                              std::span<const Body> bodies, const Colliders& colliders,
                              const dynamics::System& system) {
  const contact::Shape shape = contact::Cylinder{gripper.radius, gripper.height / 2};
  const btTransform place = place_of(robot, gripper);
  std::optional<Grip> found;
  double nearest = 0;
  for (const Collider& collider : colliders.all) {
    const bool is_other = collider.is_present && collider.entity != Collider::floor &&
                          collider.entity != robot.entity && collider.moves;
    if (!is_other || !bodies[collider.entity].is_grippable) continue;
    const btTransform pose = colliders.pose(collider, system);
    const double reach = collider.radius + contact::bounding_radius(shape);
    if (pose.getOrigin().distance2(place.getOrigin()) > reach * reach) continue;
    const contact::Manifold touch = contact::find(shape, place, collider.shape, pose, 0);
    btVector3 middle(0, 0, 0);
    double distance = 0;
    for (int i = 0; i < touch.count; ++i) {
      middle += touch.points[i].on_b / touch.count;
      distance = std::min(distance, touch.points[i].distance);
    }
    if (touch.count == 0 || (found && distance >= nearest)) continue;
    nearest = distance;
    found.emplace();
    found->held = collider.entity;
    found->part = collider.part;
    const btTransform part = bodies[collider.entity].transform(std::size_t{collider.part});
    found->point = from_bullet(part.inverse() * middle);
  }
  if (!found) return found;
  found->entity = robot.entity;
  found->max_force = gripper.max_force;
  found->spin = turret_spin(robot);
  const Vector3 seen = frame_of(*found, bodies).seen;
  found->distance = std::hypot(seen.x(), seen.y());
  found->height = seen.z();
  found->bearing = std::atan2(seen.y(), seen.x()) - turret_angle(robot);
  return found;
}

std::array<dynamics::Servo, 3> servos_of(const Grip& grip, std::span<const Body> bodies,
                                         double time_step) {
  constexpr double share = 0.2;      // of a displacement that a substep corrects
  constexpr double rounding = 1e-6;  // displacements that stay [m]
  constexpr double fastest = 1;      // correction [m/s]
  const Body& robot = bodies[grip.entity];
  const GripFrame frame = frame_of(grip, bodies);
  const double angle = turns_freely(robot) ? std::atan2(frame.seen.y(), frame.seen.x())
                                           : turret_angle(robot) + grip.bearing;
  const std::array<Vector3, 3> axes{Vector3(std::cos(angle), std::sin(angle), 0),
                                    Vector3(-std::sin(angle), std::cos(angle), 0),
                                    Vector3::UnitZ()};
  const Vector3 away = frame.seen - grip.distance * axes[0] - grip.height * axes[2];
  std::array<dynamics::Servo, 3> servos;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    dynamics::Servo& servo = servos[i];
    servo.tree = static_cast<int>(grip.entity);
    servo.other = {static_cast<int>(grip.held), static_cast<int>(grip.part)};
    servo.point = frame.held;
    servo.direction.linear = frame.robot.orientation * axes[i];
    const double off = away.dot(axes[i]);
    if (std::abs(off) > rounding)
      servo.target_velocity = std::clamp(share * off / time_step, -fastest, fastest);
    servo.upper = grip.max_force * robot.ground->time_step;
    servo.lower = -servo.upper;
    servo.impulse = grip.impulses[i];
  }
  servos[1].target_velocity -= turret_spin(robot) * grip.distance;
  if (turns_freely(robot)) servos[1].lower = servos[1].upper = servos[1].impulse = 0;
  return servos;
}

bool is_commanded_anew(const Grip& grip, std::span<const Body> bodies) {
  return turret_spin(bodies[grip.entity]) != grip.spin;
}

void end_substep(Grip& grip, std::span<Body> bodies) {
  constexpr double rounding = 1e-9;
  Body& robot = bodies[grip.entity];
  const double impulse = std::hypot(grip.impulses[0], grip.impulses[1], grip.impulses[2]);
  grip.is_torn = impulse >= (1 - rounding) * grip.max_force * robot.ground->time_step;
  grip.spin = turret_spin(robot);
  if (!turns_freely(robot)) return;
  const Vector3 seen = frame_of(grip, bodies).seen;
  robot.turret->angle =
      std::remainder(std::atan2(seen.y(), seen.x()) - grip.bearing, 2 * std::numbers::pi);
}

}  // namespace ziggurat::physics
