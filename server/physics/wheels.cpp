#include "physics/wheels.h"

#include <cmath>
#include <numbers>

namespace ziggurat::physics {
namespace {

void aim(const Body& body, GroundMotion& ground, double substep) {
  const double half = ground.angular_velocity * substep / 2;
  ground.speed =
      ground.velocity * (std::abs(half) < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half);
  ground.length = substep;
  const btVector3 x = body.transform(std::size_t{0}).getBasis().getColumn(0);
  const double heading = std::atan2(x.y(), x.x()) + half;
  ground.along.setValue(std::cos(heading), std::sin(heading), 0);
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
    aim(bodies[entity], *bodies[entity].ground, substep);
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
