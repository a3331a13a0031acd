// SPDX-License-Identifier: MIT
#include "physics/collision/colliders.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "physics/bodies/convert.h"
#include "physics/collision/shape.h"
#include "physics/multibody/prefetch.h"

namespace ziggurat::physics {
namespace {

constexpr std::size_t most_ahead = 8;  // colliders that are prefetched

/// Makes a link's collider, without a pose. None if the link has no contacts of its own.
std::optional<Collider> make_collider(const Body& body, const scene::Entity& entity,
                                      std::size_t i) {
  const scene::Link& link = entity.links[i];
  const LinkBody& placed = body.links[i];
  if (!link.collides || placed.carrier != LinkBody::carries_itself) return std::nullopt;
  Collider collider;
  collider.is_present = true;
  collider.shape = contact_shape(link.geometry);
  collider.entity = body.entity;
  collider.link = i;
  collider.part = static_cast<std::uint32_t>(placed.part);
  collider.in_part = to_bullet(placed.in_part);
  collider.is_centred = collider.in_part == btTransform::getIdentity();
  collider.is_turned = collider.in_part.getBasis() != btMatrix3x3::getIdentity();
  collider.moves = body.parts[placed.part].moves;
  collider.is_on_fixed_base = collider.moves && !entity.movable;
  collider.is_single_body = entity.movable && body.parts.size() == 1 && collider.is_centred;
  collider.has_wheels = body.ground.has_value() && i == 0;
  collider.surface = link.surface;
  collider.half_extents = to_bullet(placed.half_extents);
  collider.radius = contact::bounding_radius(collider.shape);
  return collider;
}

/// Largest speed of a point of a collider [m/s].
double speed_of(const Collider& collider) {
  return collider.velocity.length() + collider.angular_velocity.length() * collider.radius;
}

}  // namespace

double speculative_margin(const Colliders& colliders, double time_step) {
  return 1e-3 + std::max(15.0, 1.5 * colliders.gravity) * time_step * time_step;
}

void Colliders::add_floor(const scene::Surface& surface) {
  floor = all.size();
  Collider& collider = all.emplace_back();
  collider.shape = contact::HalfSpace{};
  collider.surface = surface;
}

void Colliders::add(const Body& body, const scene::Entity& entity, const dynamics::Tree& tree) {
  std::vector<Collider> made;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    if (auto collider = make_collider(body, entity, i)) made.push_back(std::move(*collider));
  }
  make_room(all, made.size());
  make_room(groups, made.size());
  follow_anew();
  for (Collider& collider : made) {  // only Bullet allocates, which does not throw
    set_pose(collider, tree);
    // Static links have a box each, which is tighter: they never leave it.
    const bool joins = &collider != &made.front() && collider.moves && groups.back().moves;
    if (!joins) groups.push_back({collider.entity, all.size(), 0, collider.moves});
    ++groups.back().count;
    collider.group = groups.size() - 1;
    all.push_back(std::move(collider));
  }
  for (std::size_t i = groups.size(); i > 0 && groups[i - 1].entity == body.entity; --i) {
    enclose(groups[i - 1]);
  }
}

Bounds Collider::bounds() const {
  btVector3 extent =
      pose.getBasis().absolute() * half_extents;  // at most that of the bounding sphere
  extent.setMin(btVector3(radius, radius, radius));
  extent += btVector3(reach, reach, reach);
  return {pose.getOrigin() - extent, pose.getOrigin() + extent};
}

/// Sets a group's box about its colliders.
void Colliders::enclose(ColliderGroup& group) {
  group.low.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  group.high = -group.low;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    const Bounds bounds = all[i].bounds();
    group.low.setMin(bounds.low);
    group.high.setMax(bounds.high);
  }
}

std::span<ColliderGroup> Colliders::groups_of(std::size_t entity) {
  const auto first = std::ranges::lower_bound(groups, entity, {}, &ColliderGroup::entity);
  const auto last = std::ranges::upper_bound(groups, entity, {}, &ColliderGroup::entity);
  return {first, last};
}

void Colliders::remove(std::size_t entity) {
  follow_anew();
  insert_new_groups();
  for (ColliderGroup& group : groups_of(entity)) {
    if (!group.proxy) continue;
    broadphase_.destroyProxy(group.proxy, nullptr);
    for (std::size_t i = group.first; i < group.first + group.count; ++i) all[i] = {};
    group = {};
    group.entity = entity;  // their order stays
  }
  while (!all.empty() && !all.back().is_present && floor != all.size() - 1) all.pop_back();
  while (!groups.empty() && !groups.back().proxy) groups.pop_back();
  inserted_ = groups.size();
}

void Colliders::reset_poses(std::size_t entity, const dynamics::Tree& tree) {
  follow_anew();
  insert_new_groups();
  for (ColliderGroup& group : groups_of(entity)) {
    if (!group.proxy) continue;
    group.is_static = false;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) set_pose(all[i], tree);
    broadphase_.destroyProxy(group.proxy, nullptr);
    enclose(group);
    insert(group, static_cast<std::size_t>(&group - groups.data()));
  }
}

void Colliders::set_pose(Collider& collider, const dynamics::Tree& tree) const {
  collider.pose = transform_of(tree, collider.part);
  if (!collider.is_centred) collider.pose *= collider.in_part;
  if (!collider.moves) return;
  const dynamics::Motion& motion = tree.spatial_velocity[collider.part];
  const math::Vector3 arm = from_bullet(collider.pose.getOrigin()) - tree.origin;
  collider.velocity = to_bullet(motion.linear + motion.angular.cross(arm));
  collider.angular_velocity = to_bullet(motion.angular);
}

btTransform Colliders::pose(const Collider& collider, const dynamics::System& system) const {
  const btTransform part = transform_of(system.trees[collider.entity], collider.part);
  return collider.is_centred ? part : part * collider.in_part;
}

void Colliders::update_poses(const dynamics::System& system, double time_step) {
  near_floor_.resize(all.size());
  for (std::size_t i = inserted_; i < groups.size(); ++i)
    update_poses(groups[i], system, time_step);  // with boxes that last
  insert_new_groups();
  has_woken = false;
  updated_groups_.clear();
  predicted.clear();
  fast_entities.clear();
  const double margin = speculative_margin(*this, time_step);
  if (sleep_changes_ != system.sleep_changes() || margin_ != margin) follow_anew();
  sleep_changes_ = system.sleep_changes();
  margin_ = margin;
  changed_.clear();
  const bool is_steady = passes_left_ == 0;
  if (is_steady) {
    for (const std::size_t index : followed_) follow(groups[index], system);
  } else {
    --passes_left_;
    for (ColliderGroup& group : groups) {
      if (group.proxy) follow(group, system);
    }
  }
  update_changed(system, time_step, true);
  if (!is_steady) followed_ = updated_groups_;
}

/// Updates the poses of the changed groups, and their boxes. Poses are shared by the team.
/// @param shrinks  see update_box()
void Colliders::update_changed(const dynamics::System& system, double time_step, bool shrinks) {
  constexpr std::size_t block = 16;  // groups that a thread takes at once
  const std::size_t count = changed_.size();
  steps_.resize(count);
  dynamics::share_in_blocks(team, count, block, [&](std::size_t i, unsigned) {
    ColliderGroup& group = groups[changed_[i]];
    steps_[i].length = update_poses(group, system, time_step);
    steps_[i].fits_box = fits_box(group, steps_[i].length, shrinks);
  });
  const double fast = speculative_margin(*this, time_step) / 2;
  for (std::size_t i = 0; i < count; ++i) {
    ColliderGroup& group = groups[changed_[i]];
    if (steps_[i].length > fast) fast_entities.push_back(static_cast<int>(group.entity));
    if (group.moves) updated_groups_.push_back(changed_[i]);
    if (!steps_[i].fits_box) update_box(group, steps_[i].length, shrinks);
  }
}

/// Notes whether a group stands; lists it unless it stood in the substep before and still does.
void Colliders::follow(ColliderGroup& group, const dynamics::System& system) {
  group.was_static = group.is_static;
  group.is_static = !group.moves || system.is_asleep(static_cast<int>(group.entity));
  has_woken |= group.was_static && !group.is_static;
  if (group.moves ? group.is_unchanged() : all[group.first].reach == margin_) return;
  changed_.push_back(static_cast<std::size_t>(&group - groups.data()));
}

void Colliders::update_poses(const dynamics::System& system, double time_step,
                             const TreeSet& active) {
  near_floor_.resize(all.size());
  insert_new_groups();
  updated_groups_.clear();
  predicted.clear();
  fast_entities.clear();
  changed_.clear();
  each_of(groups, active, [&](ColliderGroup& group) {
    if (!group.proxy || !group.moves) return;
    group.is_static = false;
    changed_.push_back(static_cast<std::size_t>(&group - groups.data()));
  });
  update_changed(system, time_step, false);
}

/// Prefetches the memory that update_poses() takes for the groups after one.
void Colliders::prefetch_after(const ColliderGroup& group, const dynamics::System& system) const {
  const auto later = [&](std::size_t by) -> const ColliderGroup* {
    const std::size_t index = static_cast<std::size_t>(&group - groups.data()) + by;
    return index < groups.size() && groups[index].moves ? &groups[index] : nullptr;
  };
  if (const ColliderGroup* next = later(6))
    dynamics::prefetch(&system.trees[next->entity], sizeof(dynamics::Tree));
  if (const ColliderGroup* next = later(3)) {
    const dynamics::Tree& tree = system.trees[next->entity];
    dynamics::prefetch(tree.rotation);
    dynamics::prefetch(tree.position);
    dynamics::prefetch(tree.spatial_velocity);
    dynamics::prefetch(&all[next->first], std::min(next->count, most_ahead) * sizeof(Collider));
    dynamics::prefetch(next->proxy, sizeof(*next->proxy));
  }
}

/// Updates poses and velocities of a group's colliders. It changes nothing of other groups.
/// @return  how far it moves [m]
double Colliders::update_poses(ColliderGroup& group, const dynamics::System& system,
                               double time_step) {
  const double margin = speculative_margin(*this, time_step);
  double fastest = 0;
  if (group.moves) prefetch_after(group, system);
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    Collider& collider = all[i];
    collider.reach = margin;
    if (!group.moves) continue;
    set_pose(collider, system.trees[group.entity]);
    const double speed = speed_of(collider);
    collider.reach += 1.3 * time_step * speed;
    fastest = std::max(fastest, speed);
    note_floor(i);
  }
  enclose(group);
  return time_step * fastest;
}

/// Notes whether a collider may come near the floor.
void Colliders::note_floor(std::size_t collider) {
  const Collider& it = all[collider];
  near_floor_[collider] = !(it.pose.getOrigin().z() > it.radius + it.reach);
}

bool Colliders::add_predictions(std::span<const int> trees, const dynamics::System& system,
                                double time_step) {
  bool any = false;
  const auto is_known = [&](std::size_t index, const Collider& moved) {
    const auto moves_so = [&](const Collider& known) {
      const double turns =
          (moved.angular_velocity - known.angular_velocity).length() * moved.radius;
      return time_step * ((moved.velocity - known.velocity).length() + turns) <=
             speculative_margin(*this, time_step);
    };
    return moves_so(all[index]) ||
           std::ranges::any_of(predicted, [&](const PredictedCollider& known) {
             return known.index == index && moves_so(known.collider);
           });
  };
  for (const int tree : trees) {
    for (ColliderGroup& group : groups_of(static_cast<std::size_t>(tree))) {
      double fastest = 0;
      for (std::size_t i = group.first; i < group.first + group.count; ++i) {
        Collider moved = all[i];
        set_pose(moved, system.trees[tree]);
        if (is_known(i, moved)) continue;
        const double speed = speed_of(moved);
        all[i].reach = moved.reach = std::max(
            all[i].reach, btScalar(speculative_margin(*this, time_step) + 1.3 * time_step * speed));
        note_floor(i);
        predicted.push_back({i, std::move(moved)});
        fastest = std::max(fastest, speed);
      }
      if (fastest == 0) continue;
      any = true;
      enclose(group);
      update_box(group, time_step * fastest, false);
    }
  }
  return any;
}

}  // namespace ziggurat::physics
