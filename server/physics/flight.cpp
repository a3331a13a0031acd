// SPDX-License-Identifier: MIT
#include "physics/flight.h"

#include <cmath>

#include "physics/bodies/convert.h"

namespace ziggurat::physics {
namespace {

using math::Quaternion;
using math::Vector3;

/// Rates of the outer and the inner loop [1/s].
struct Gains {
  double outer, inner;
};
constexpr Gains of_position{1, 4}, of_heading{2, 8};

Vector3 limited(const Vector3& vector, double most) {
  const double length = vector.norm();
  return length > most ? Vector3(vector * (most / length)) : vector;
}

/// Acceleration that takes a substep's share of an error of velocity away.
Vector3 acceleration(const Vector3& error, double rate, double substep, double most) {
  return limited(error * (-std::expm1(-rate * substep) / substep), most);
}

Quaternion upright(double heading) {
  return Quaternion(Eigen::AngleAxisd(heading, Vector3::UnitZ()));
}

/// Rotation vector from an orientation to another, the short way [rad].
Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  Quaternion turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  if (sine == 0) return Vector3::Zero();
  return turn.vec() * (2 * std::atan2(sine, turn.w()) / sine);
}

/// Pose and motion of a body.
struct Motion {
  math::Pose origin;         // X_WE
  Vector3 velocity;          // of the centre of mass [m/s]
  Vector3 angular_velocity;  // [rad/s]
  Eigen::Matrix3d inertia;   // in W [kg m^2]
};

Motion motion_of(const Body& body, const Twist& twist) {
  const math::Pose part = from_bullet(body.transform(std::size_t{0}));
  const Eigen::Matrix3d axes = part.orientation.toRotationMatrix();
  return {part * body.links[body.reference_link].frame_in_part() * body.origin_from_reference,
          from_bullet(twist.velocity), from_bullet(twist.angular_velocity),
          axes * body.parts[0].inertia.asDiagonal() * axes.transpose()};
}

Vector3 wanted_velocity(const FlyingBody& flight, const Motion& now) {
  const FlightTarget& target = flight.target;
  const Vector3 wanted = target.holds_position
                             ? Vector3(of_position.outer * (target.position - now.origin.position))
                             : Vector3(upright(math::heading_of(now.origin)) * target.velocity);
  return limited(wanted, flight.limits.max_speed);
}

Vector3 wanted_turn(const FlyingBody& flight, const Motion& now) {
  const FlightTarget& target = flight.target;
  const double heading = target.holds_heading ? target.heading : math::heading_of(now.origin);
  Vector3 wanted = of_heading.outer * rotation_between(now.origin.orientation, upright(heading));
  if (!target.holds_heading) wanted.z() += target.turn_rate;
  return limited(wanted, flight.limits.max_turn_rate);
}

}  // namespace

FlightTarget hover_at(const math::Pose& pose) {
  FlightTarget target;
  target.position = pose.position;
  target.heading = math::heading_of(pose);
  return target;
}

void Flight::body_added(Body& body) {
  if (body.flight && body.parts[0].moves) entities_.push_back(body.entity);
}

void Flight::body_removed(const Body& body) { std::erase(entities_, body.entity); }

void Flight::body_moved(Body& body) {
  if (!body.flight) return;
  FlightTarget& target = body.flight->target;
  const FlightTarget here = hover_at(body.placed);
  if (target.holds_position) target.position = here.position;
  if (target.holds_heading) target.heading = here.heading;
}

void Flight::before_substep(std::span<Body> bodies, double substep) {
  for (const std::size_t entity : entities_) {
    Body& body = bodies[entity];
    body.motions(motions_);
    const FlyingBody& flight = *body.flight;
    const Motion now = motion_of(body, motions_[0]);
    const Vector3 push = acceleration(wanted_velocity(flight, now) - now.velocity,
                                      of_position.inner, substep, flight.limits.max_acceleration);
    const Vector3 turn =
        acceleration(wanted_turn(flight, now) - now.angular_velocity, of_heading.inner, substep,
                     flight.limits.max_turn_acceleration);
    const Vector3 torque = now.inertia * turn +
                           now.angular_velocity.cross(Vector3(now.inertia * now.angular_velocity));
    body.apply_force(0, to_bullet(Vector3(body.parts[0].mass * push)));
    body.apply_torque(0, to_bullet(torque));
  }
}

}  // namespace ziggurat::physics
