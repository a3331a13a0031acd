#include "physics/placement.h"

#include "physics/overlap.h"

namespace ziggurat::physics {

struct Placement::Parts {
  struct Placed {
    std::size_t entity;  // into ids
    PlacedCollider collider;
  };
  std::vector<std::string> ids;
  std::vector<Placed> placed;
};

Placement::Placement() : parts_(std::make_unique<Parts>()) {}
Placement::~Placement() = default;

void Placement::add(const scene::Entity& entity) {
  for (const PlacedCollider& collider : placed_colliders(entity)) {
    parts_->placed.push_back({parts_->ids.size(), collider});
  }
  parts_->ids.push_back(entity.id);
}

std::string Placement::overlapped_by(const scene::Entity& entity) const {
  const std::vector<PlacedCollider> candidates = placed_colliders(entity);
  for (const Parts::Placed& other : parts_->placed) {
    for (const PlacedCollider& candidate : candidates) {
      if (overlaps(candidate, other.collider)) return parts_->ids[other.entity];
    }
  }
  return {};
}

}  // namespace ziggurat::physics
