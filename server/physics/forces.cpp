// SPDX-License-Identifier: MIT
#include "physics/forces.h"

#include <algorithm>

#include "physics/bodies/convert.h"

namespace ziggurat::physics {

void ViscousDamping::body_added(Body& body) {
  const bool damped = std::any_of(body.links.begin(), body.links.end(), [](const LinkBody& link) {
    return link.moves && (link.damping.linear > 0 || link.damping.angular > 0);
  });
  if (damped) damped_.push_back(body.entity);
}

void ViscousDamping::body_removed(const Body& body) { std::erase(damped_, body.entity); }

void ViscousDamping::before_substep(std::span<Body> bodies, double substep) {
  // Damping stops a velocity that a step of the law would reverse.
  const auto rate = [substep](double factor, double speed) {
    return std::min(factor * (1 + speed), 1 / substep);
  };
  for (const std::size_t entity : damped_) {
    Body& body = bodies[entity];
    body.motions(motions_);
    for (const LinkBody& link : body.links) {
      if (!link.moves) continue;
      const auto [v, w] = body.motion(link, motions_);
      const btVector3 force = -v * (link.mass * rate(link.damping.linear, v.length()));
      const btTransform pose = body.transform(link);
      const btMatrix3x3& basis = pose.getBasis();
      const btVector3 momentum = basis * (to_bullet(link.inertia) * (basis.transpose() * w));
      const btVector3 arm = pose.getOrigin() - body.transform(link.part).getOrigin();
      body.apply_force(link.part, force);
      body.apply_torque(link.part,
                        arm.cross(force) - momentum * rate(link.damping.angular, w.length()));
    }
  }
}

}  // namespace ziggurat::physics
