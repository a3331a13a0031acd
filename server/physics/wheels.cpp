// SPDX-License-Identifier: MIT
#include "physics/wheels.h"

#include <cmath>
#include <numbers>

namespace ziggurat::physics {
namespace {

constexpr btScalar slowest = btScalar(1e-6);  // of what slides [m/s]

/// Friction of what does not drive is along its motion: so it is the same in all directions, until
/// it stands.
/// @return  unit, level, or 0 where nothing moves
btVector3 sliding(const Body& body, const GroundMotion& ground, std::vector<Twist>& motions) {
  if (ground.velocity != 0 || ground.angular_velocity != 0) return {0, 0, 0};
  body.motions(motions);
  const btVector3 level(motions[0].velocity.x(), motions[0].velocity.y(), 0);
  const btScalar speed = level.length();
  return speed > slowest ? level / speed : btVector3(0, 0, 0);
}

/// @param direction  of its motion, or 0: that of its heading
void aim(const Body& body, GroundMotion& ground, const btVector3& direction, double substep) {
  const double half = ground.angular_velocity * substep / 2;
  ground.speed =
      ground.velocity * (std::abs(half) < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half);
  ground.time_step = substep;
  const btVector3 x = body.transform(std::size_t{0}).getBasis().getColumn(0);
  const double heading = std::atan2(x.y(), x.x()) + half;
  ground.along =
      direction.isZero() ? btVector3(std::cos(heading), std::sin(heading), 0) : direction;
  ground.across.setValue(-ground.along.y(), ground.along.x(), 0);
}

/// @param turn_rate  of the robot [rad/s]
void turn(Body& body, double turn_rate, double substep) {
  Turret& turret = *body.turret;
  const double wanted = body.ground->angular_velocity + turret.speed;
  if (!turret.follows) {
    const double turned = (wanted - turn_rate) * substep;
    turret.angle = std::remainder(turret.angle + turned, 2 * std::numbers::pi);
  }
  LinkBody& link = body.links[turret.link];
  link.turn = Eigen::AngleAxisd(turret.angle, math::Vector3::UnitZ());
  link.spin = turret.follows ? 0 : wanted - turn_rate;
}

}  // namespace

void Wheels::body_added(Body& body) {
  if (body.ground) entities_.push_back(body.entity);
}

void Wheels::body_removed(const Body& body) { std::erase(entities_, body.entity); }

void Wheels::body_moved(Body& body) {
  if (!body.turret) return;
  body.turret->angle = 0;
  body.links[body.turret->link].turn = math::Quaternion::Identity();
  body.links[body.turret->link].spin = 0;
}

void Wheels::before_substep(std::span<Body> bodies, double substep) {
  for (const std::size_t entity : entities_) {
    GroundMotion& ground = *bodies[entity].ground;
    aim(bodies[entity], ground, sliding(bodies[entity], ground, motions_), substep);
  }
}

void Wheels::after_substep(std::span<Body> bodies, double substep) {
  for (const std::size_t entity : entities_) {
    Body& body = bodies[entity];
    if (!body.turret) continue;
    body.motions(motions_);
    turn(body, motions_[0].angular_velocity.z(), substep);
  }
}

}  // namespace ziggurat::physics
