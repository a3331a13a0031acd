#include "physics/forces.h"

#include <algorithm>

#include "physics/convert.h"

namespace ziggurat::physics {

void Gravity::before_substep(std::span<Body> bodies, double) {
  for (const Body& body : bodies) {
    if (body.rigid && !body.rigid->isActive()) continue;
    for (const Part& part : body.parts) {
      if (part.moves) part.apply_force(btVector3(0, 0, -g_ * part.mass));
    }
  }
}

void ViscousDamping::body_added(const Body& body) {
  const bool damped = std::any_of(body.links.begin(), body.links.end(), [](const LinkBody& link) {
    return link.moves && (link.damping.linear > 0 || link.damping.angular > 0);
  });
  if (damped) damped_.push_back(body.entity);
}

void ViscousDamping::body_removed(const Body& body) { std::erase(damped_, body.entity); }

void ViscousDamping::before_substep(std::span<Body> bodies, double) {
  for (const std::size_t entity : damped_) {
    const Body& body = bodies[entity];
    body.motions(motions_);
    for (const LinkBody& link : body.links) {
      if (!link.moves) continue;
      const Part& part = body.parts[link.part];
      const auto [v, w] = body.motion(link, motions_);
      const btVector3 force = -v * (link.mass * link.damping.linear * (1 + v.length()));
      const btTransform pose = body.transform(link);
      const btMatrix3x3& basis = pose.getBasis();
      const btVector3 momentum = basis * (to_bullet(link.inertia) * (basis.transpose() * w));
      const btVector3 arm = pose.getOrigin() - part.transform().getOrigin();
      part.apply_force(force);
      part.apply_torque(arm.cross(force) - momentum * (link.damping.angular * (1 + w.length())));
    }
  }
}

}  // namespace ziggurat::physics
