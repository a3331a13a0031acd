#include "physics/placement.h"

#include "physics/assembly.h"
#include "physics/contact/shapes.h"
#include "physics/convert.h"
#include "physics/geometry.h"

namespace ziggurat::physics {
namespace {

struct Placed {
  std::size_t entity = 0;
  contact::Shape shape;
  btTransform pose;
  btScalar radius = 0;  // of the bounding sphere [m]
};

/// Below this two bodies overlap rather than touch: rounding is a thousand times smaller [m].
constexpr btScalar overlap = -1e-8;

std::vector<Placed> colliders(const scene::Entity& entity, std::size_t number) {
  std::vector<Placed> placed;
  const std::vector<math::Pose> assembled = assemble(entity);
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const scene::Link& link = entity.links[i];
    if (!link.collides) continue;
    const math::Pose centre{center_of_mass(link.geometry), math::Quaternion::Identity()};
    placed.push_back({number, contact_shape(link.geometry),
                      to_bullet(entity.pose * assembled[i] * centre),
                      bounding_radius(link.geometry)});
  }
  return placed;
}

bool overlaps(const Placed& a, const Placed& b) {
  const btScalar reach = a.radius + b.radius;
  if ((a.pose.getOrigin() - b.pose.getOrigin()).length2() > reach * reach) return false;
  const contact::Contacts contacts = contact::find(a.shape, a.pose, b.shape, b.pose, 0);
  for (int i = 0; i < contacts.count; ++i) {
    if (contacts.points[i].distance < overlap) return true;
  }
  return false;
}

}  // namespace

struct Placement::Parts {
  std::vector<std::string> ids;
  std::vector<Placed> placed;
};

Placement::Placement() : parts_(std::make_unique<Parts>()) {}
Placement::~Placement() = default;

void Placement::add(const scene::Entity& entity) {
  for (Placed& placed : colliders(entity, parts_->ids.size())) parts_->placed.push_back(placed);
  parts_->ids.push_back(entity.id);
}

std::string Placement::overlapped_by(const scene::Entity& entity) const {
  const std::vector<Placed> candidates = colliders(entity, 0);
  for (const Placed& other : parts_->placed) {
    for (const Placed& candidate : candidates) {
      if (overlaps(candidate, other)) return parts_->ids[other.entity];
    }
  }
  return {};
}

}  // namespace ziggurat::physics
