// SPDX-License-Identifier: MIT
#pragma once
// Ray casts against all colliders and the floor, for proximity sensors and lines of sight. They
// work on published poses, so their answers belong to a tick.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "world/state.h"

namespace ziggurat::dynamics {
class Team;
}

namespace ziggurat::physics {

struct RayHit {
  double distance = 0;                ///< from the start [m]
  std::optional<std::size_t> entity;  ///< in order of adding; none: the floor
};

/// A segment in W, and what it does not see.
struct RayQuery {
  math::Vector3 start = math::Vector3::Zero(), end = math::Vector3::Zero();  ///< [m]
  std::span<const std::size_t> ignored;  ///< entities that it passes through
  bool sees_floor = false;
};

/// Colliders that rays in one place may meet.
struct Candidates {
  std::vector<std::size_t> colliders;
  bool are_few = false;  ///< otherwise not all are listed: a ray finds the first faster by itself
};

class Rays {
 public:
  explicit Rays(const scene::Physics& physics);
  ~Rays();
  Rays(Rays&&) noexcept;

  /// Adds an entity; its links take the next places of State::links.
  void add(const scene::Entity& entity);

  /// Rays meet the entity no more; its places in State::links stay its own.
  /// @param entity  in order of adding
  void remove(std::size_t entity);

  /// Forgets the entity that was added last.
  void take_back();

  /// Takes the poses of a tick. Must be called before casts, which several threads may do at once.
  /// @param team  whose threads share the work; null: the caller's
  void update(const world::State& state, dynamics::Team* team = nullptr);

  /// Casts a segment: the closest entity that it meets before its end. A body around its start does
  /// not stop it, unless the start is within 0.1 mm below the surface on the way in: a touching
  /// body is met at 0. The floor is met from above only.
  std::optional<RayHit> cast(const RayQuery& query) const;

  /// Finds colliders that may reach into a box, for many rays in one place.
  /// @param low, high  corners of the box in W [m];  @param ignored  entities without which
  void find(const math::Vector3& low, const math::Vector3& high,
            std::span<const std::size_t> ignored, Candidates& out) const;

  /// The same as cast(query) for a segment inside the box of find() that ignores what it did;
  /// faster.
  std::optional<RayHit> cast(const RayQuery& query, const Candidates& candidates) const;

 private:
  struct Parts;
  struct Flight;
  std::unique_ptr<Parts> parts_;
};

/// Entry of a segment into a shape: the share of the segment's length, at least -skin / length and
/// less than 1. Nothing if it starts inside or misses.
/// @param start, end  in the link's frame [m]
/// @param skin  depth below the surface that still counts as outside on the way in [m]
std::optional<double> enter(const scene::Geometry& geometry, const math::Vector3& start,
                            const math::Vector3& end, double skin);

}  // namespace ziggurat::physics
