// SPDX-License-Identifier: MIT
// Overlap recovery. Contacts are linear in the displacement. A body that rotates far in a substep,
// as at an impact of a corner, may penetrate with other corners at its end. So may a body that an
// impact or a push-out moves off its predicted path.

#include <algorithm>
#include <cmath>

#include "physics/bodies/convert.h"
#include "physics/collision/contact_cache.h"
#include "physics/stepping/team.h"

namespace ziggurat::physics {
namespace {

constexpr btScalar most_gap = btScalar(1e-3);  // gap below which points are checked for overlap [m]
constexpr double least_overlap = 2e-5;         // [m]

bool overlaps_deeply(const contact::Manifold& found) {
  return std::any_of(
      found.points.begin(), found.points.begin() + found.count,
      [](const contact::ManifoldPoint& point) { return point.distance < -least_overlap; });
}

/// A coarser bound than predicted_pose_error(), for an angle that rounding makes uncertain by 1e-7.
/// @param tree  of the collider, after the substep
double coarse_pose_error(const Collider& moving, const dynamics::Tree& tree, double time_step) {
  const Eigen::Matrix3d& turn = tree.rotation[moving.part];
  math::Vector3 origin = tree.position[moving.part];
  if (!moving.is_centred) origin += turn * from_bullet(moving.in_part.getOrigin());
  const btVector3 way = to_bullet(origin) - moving.pose.getOrigin() - time_step * moving.velocity;
  double cosines = 0;
  for (int row = 0; row < 3; ++row) {
    const btVector3& before = moving.pose.getBasis()[row];
    cosines += before.x() * turn(row, 0) + before.y() * turn(row, 1) + before.z() * turn(row, 2);
  }
  const double angle = std::sqrt(std::max(0.0, 3 - cosines)) + 1e-7;
  return way.length() + moving.radius * (angle + time_step * moving.angular_velocity.length());
}

/// Bound of the distance of a collider's points from their predicted positions [m].
/// @param now     its pose after the substep
/// @param time_step  of the substep [s]
double predicted_pose_error(const Collider& moving, const btTransform& now, double time_step) {
  const btVector3 way = now.getOrigin() - moving.pose.getOrigin() - time_step * moving.velocity;
  double turn = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const btVector3 before = moving.pose.getBasis().getColumn(axis);
    turn += (now.getBasis().getColumn(axis) - before -
             time_step * moving.angular_velocity.cross(before))
                .length2();
  }
  return way.length() + moving.radius * std::sqrt(turn / 2);
}

}  // namespace

/// Whether a pair is to be checked for overlap: its moving side rotated far, or is off its
/// predicted pose.
bool ContactCache::is_off_prediction(const ListedPair& listed,
                                     const dynamics::System& system) const {
  if (!listed.has_static_side) return false;
  const CachedPair& pair = pairs_[listed.pair];
  if (pair.count == 0 && !listed.has_no_contact) return false;  // hidden
  if (listed.rotation.may_overlap || listed.rotation.tumbles) return true;
  const Collider& a = colliders_.all[pair.a];
  const Collider& moving = a.moves ? a : colliders_.all[pair.b];
  const dynamics::Tree& tree = system.trees[moving.entity];
  // Contacts were found with the slack.
  if (!moving.is_turned && coarse_pose_error(moving, tree, time_step_) <= slack_) return false;
  return predicted_pose_error(moving, colliders_.pose(moving, system), time_step_) > slack_;
}

std::span<dynamics::ContactPoint> ContactCache::find_new_overlaps(const dynamics::System& system) {
  constexpr std::size_t block = 32;  // pairs that a thread takes at once
  overlaps_.clear();
  dynamics::share_in_blocks(team_, listed_.size(), block, [&](std::size_t i, unsigned) {
    listed_[i].is_off = is_off_prediction(listed_[i], system);
  });
  for (const ListedPair& listed : listed_) {
    if (!listed.is_off) continue;
    const CachedPair& pair = pairs_[listed.pair];
    const Collider& a = colliders_.all[pair.a];
    const Collider& b = colliders_.all[pair.b];
    const btTransform of_a = a.moves ? colliders_.pose(a, system) : a.pose;
    const btTransform of_b = b.moves ? colliders_.pose(b, system) : b.pose;
    const contact::Manifold found =
        contact::find(a.shape, of_a, b.shape, of_b, most_gap, contact::Support::all);
    if (!overlaps_deeply(found)) continue;
    const dynamics::ContactPoint law =
        contact_of(a, b, listed.has_no_contact ? from_bullet(found.normal) : pair.normal,
                   std::max(pair.count, 1));
    for (int i = 0; i < found.count; ++i) {
      dynamics::ContactPoint& contact = overlaps_.emplace_back(law);
      contact.normal = from_bullet(found.normal);
      contact.point = from_bullet(found.points[i].on_b);
      contact.gap = found.points[i].distance;
    }
  }
  return overlaps_;
}

}  // namespace ziggurat::physics
