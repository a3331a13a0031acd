#include "physics/bodies.h"

#include "physics/bullet/mechanism.h"
#include "physics/convert.h"

namespace ziggurat::physics {

using math::Pose;

Body::Body() = default;
Body::~Body() = default;
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(Body&&) noexcept = default;

Pose LinkBody::frame_in_part() const { return in_part * math::inverse(center); }

Pose base_pose(const Body& body) {
  const LinkBody& root = body.links[body.reference_link];
  return root.placed * math::inverse(root.frame_in_part());
}

btTransform Body::transform(std::size_t part) const {
  return mechanism ? mechanism->transform(part) : articulation->transform(part);
}

btTransform Body::transform(const LinkBody& link) const {
  return transform(link.part) *
         btTransform(to_bullet(math::Quaternion(link.turn * link.in_part.orientation)),
                     to_bullet(link.in_part.position));
}

void Body::apply_force(std::size_t part, const btVector3& force) {
  mechanism ? mechanism->apply_force(part, force) : articulation->apply_force(part, force);
}

void Body::apply_torque(std::size_t part, const btVector3& torque) {
  mechanism ? mechanism->apply_torque(part, torque) : articulation->apply_torque(part, torque);
}

bool Body::sleeps() const { return mechanism ? mechanism->sleeps() : articulation->sleeps(); }

/// A tree of dynamics/ wakes by itself when the forces on it are not those that it rests under.
void Body::wake() {
  if (mechanism && mechanism->rigid) mechanism->rigid->activate(true);
}

void Body::update_poses() {
  if (mechanism) mechanism->update_poses();
}

void Body::motions(std::vector<Twist>& out) const {
  out.resize(parts.size());
  mechanism ? mechanism->motions(out) : articulation->motions(out);
}

Twist Body::motion(const LinkBody& link, std::span<const Twist> parts_motion) const {
  const btMatrix3x3 basis = transform(link.part).getBasis();
  Twist motion = parts_motion[link.part];
  motion.velocity += motion.angular_velocity.cross(basis * to_bullet(link.in_part.position));
  motion.angular_velocity += basis.getColumn(2) * link.spin;
  return motion;
}

}  // namespace ziggurat::physics
