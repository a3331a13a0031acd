// SPDX-License-Identifier: MIT
#include "physics/bodies/bodies.h"

#include "physics/bodies/convert.h"

namespace ziggurat::physics {

using math::Pose;

Pose LinkBody::frame_in_part() const { return in_part * math::inverse(center); }

Pose base_pose(const Body& body) {
  const LinkBody& root = body.links[body.reference_link];
  return root.placed * math::inverse(root.frame_in_part());
}

btTransform Body::transform(std::size_t part) const { return articulation->transform(part); }

btTransform Body::transform(const LinkBody& link) const {
  return transform(link.part) *
         btTransform(to_bullet(math::Quaternion(link.turn * link.in_part.orientation)),
                     to_bullet(link.in_part.position));
}

void Body::apply_force(std::size_t part, const btVector3& force) {
  articulation->apply_force(part, force);
}

void Body::apply_torque(std::size_t part, const btVector3& torque) {
  articulation->apply_torque(part, torque);
}

bool Body::sleeps() const { return articulation->sleeps(); }

void Body::motions(std::vector<Twist>& out) const {
  out.resize(parts.size());
  articulation->motions(out);
}

Twist Body::motion(const LinkBody& link, std::span<const Twist> parts_motion) const {
  const btMatrix3x3 basis = transform(link.part).getBasis();
  Twist motion = parts_motion[link.part];
  motion.velocity += motion.angular_velocity.cross(basis * to_bullet(link.in_part.position));
  motion.angular_velocity += basis.getColumn(2) * link.spin;
  return motion;
}

}  // namespace ziggurat::physics
