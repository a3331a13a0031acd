// SPDX-License-Identifier: MIT
#include "physics/bodies/convert.h"
#include "physics/forces.h"

namespace ziggurat::physics {

void ExternalForces::before_substep(std::span<Body> bodies, double) {
  for (const Force& push : forces_) {
    Body& body = bodies[push.entity];
    if (push.link >= body.links.size()) continue;  // removed
    const LinkBody& link = body.links[push.link];
    if (!link.moves) continue;
    const btVector3 force = to_bullet(push.force);
    const btVector3 arm = body.transform(link).getOrigin() - body.transform(link.part).getOrigin();
    body.apply_force(link.part, force);
    body.apply_torque(link.part, arm.cross(force) + to_bullet(push.torque));
  }
}

}  // namespace ziggurat::physics
