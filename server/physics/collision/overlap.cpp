// SPDX-License-Identifier: MIT
#include "physics/collision/overlap.h"

#include "physics/bodies/bodies.h"
#include "physics/bodies/convert.h"
#include "physics/collision/shape.h"

namespace ziggurat::physics {

std::vector<PlacedCollider> placed_colliders(const scene::Entity& entity,
                                             const math::Pose& origin) {
  std::vector<PlacedCollider> placed;
  const std::vector<math::Pose> assembled = assemble(entity);
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const scene::Link& link = entity.links[i];
    if (!link.collides) continue;
    const math::Pose pose = origin * assembled[i] * shape_frame(link.geometry);
    placed.push_back({contact_shape(link.geometry), to_bullet(pose)});
  }
  return placed;
}

bool overlaps(const PlacedCollider& a, const PlacedCollider& b, double depth) {
  const contact::Manifold contacts = contact::find(a.shape, a.pose, b.shape, b.pose, 0);
  for (int i = 0; i < contacts.count; ++i) {
    if (contacts.points[i].distance < -depth) return true;
  }
  return false;
}

}  // namespace ziggurat::physics
