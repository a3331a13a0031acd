// SPDX-License-Identifier: MIT
#include "physics/placement.h"

#include <algorithm>

#include "physics/collision/overlap.h"
#include "physics/collision/sphere_grid.h"

namespace ziggurat::physics {

struct Placement::Parts {
  struct Placed {
    std::size_t entity;  // into ids
    PlacedCollider collider;
  };
  std::vector<std::string> ids;
  std::vector<Placed> placed;
  SphereGrid nearby;  // of `placed`
  std::size_t effort = 0;
};

Placement::Placement() : parts_(std::make_unique<Parts>()) {}
Placement::~Placement() = default;

void Placement::add(const scene::Entity& entity) {
  for (const PlacedCollider& collider : placed_colliders(entity, entity.pose)) {
    parts_->nearby.add(parts_->placed.size(), collider.pose.getOrigin(),
                       contact::bounding_radius(collider.shape));
    parts_->placed.push_back({parts_->ids.size(), collider});
  }
  parts_->ids.push_back(entity.id);
}

std::string Placement::overlapped_by(const scene::Entity& entity) const {
  constexpr std::size_t of_collider = 5, of_test = 10;  // a neighbour that is passed over: 1
  const std::size_t none = parts_->placed.size();
  std::size_t first = none;
  for (const PlacedCollider& candidate : placed_colliders(entity, entity.pose)) {
    parts_->effort += of_collider;
    parts_->nearby.visit(candidate.pose.getOrigin(), contact::bounding_radius(candidate.shape),
                         [&](std::size_t i) {
                           const auto& other = parts_->placed[i];
                           ++parts_->effort;
                           if (i >= first) return;
                           parts_->effort += of_test;
                           if (overlaps(candidate, other.collider, placed_depth)) first = i;
                         });
  }
  return first == none ? std::string() : parts_->ids[parts_->placed[first].entity];
}

std::size_t Placement::effort() const { return parts_->effort; }

}  // namespace ziggurat::physics
