#include "physics/forces.h"

#include <algorithm>

#include "physics/convert.h"

namespace ziggurat::physics {

void Gravity::before_substep(std::span<Body> bodies, double) {
  for (const Body& body : bodies) {
    if (body.rigid && !body.rigid->isActive()) continue;
    for (const LinkBody& link : body.links) {
      if (link.moves && link.mass > 0) link.apply_force(btVector3(0, 0, -g_ * link.mass));
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
    for (std::size_t i = 0; i < body.links.size(); ++i) {
      const LinkBody& link = body.links[i];
      if (!link.moves) continue;
      const btVector3& v = motions_[i].velocity;
      link.apply_force(-v * (link.mass * link.damping.linear * (1 + v.length())));
      const btVector3& w = motions_[i].angular_velocity;
      const btMatrix3x3 basis = link.transform().getBasis();
      const btVector3 momentum = basis * (to_bullet(link.inertia) * (basis.transpose() * w));
      link.apply_torque(-momentum * (link.damping.angular * (1 + w.length())));
    }
  }
}

}  // namespace ziggurat::physics
