// SPDX-License-Identifier: MIT
#pragma once
// Colliders: the shapes of all parts, their poses, and the broad phase that finds pairs near each
// other within a substep (Bullet's trees of boxes).

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies/bodies.h"
#include "physics/collision/pair_lists.h"
#include "physics/collision/shapes.h"
#include "physics/stepping/system.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Along the world's axes.
struct Bounds {
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< corners [m]
};

/// Data that each substep reads and writes comes first, and fills four lines of the cache.
struct alignas(64) Collider {
  static constexpr std::size_t floor = static_cast<std::size_t>(-1);

  // State of the coming substep:
  btTransform pose = btTransform::getIdentity();  ///< X_WS
  btVector3 velocity{0, 0, 0};                    ///< of the shape's centre [m/s]
  btVector3 angular_velocity{0, 0, 0};            ///< [rad/s]
  double reach = 0;                               ///< distance that its surface may move [m]

  double radius = 0;  ///< of the sphere about the shape's centre that holds it [m]
  btVector3 half_extents{0, 0,
                         0};   ///< half extents of the box about it and its centre, in its axes [m]
  std::size_t entity = floor;  ///< its number, and that of its tree
  std::uint32_t part = 0;      ///< into Body::parts
  bool is_centred = true;      ///< in_part is the identity
  bool moves = false;
  bool is_present = false;  ///< false: removed; also false of the floor
  bool has_wheels = false;  ///< has wheels: no friction with bodies below or above it

  bool is_turned = false;  ///< in_part is more than a translation
  std::size_t group = 0;   ///< into the broad phase's groups
  std::size_t link = 0;    ///< into Body::links
  bool is_on_fixed_base =
      false;  ///< on joints from something that stands: its centre moves on a circle
  bool is_single_body = false;  ///< the only part of a free entity, with its centre at the part's
  scene::Surface surface;
  contact::Shape shape;
  btTransform in_part = btTransform::getIdentity();  ///< X_PS

  Bounds bounds() const;  ///< of it and its reach
  void archive(math::Archive& archive);
};

/// A box of the broad phase: all colliders of an entity that moves, or one of an entity that
/// stands.
struct ColliderGroup {
  std::size_t entity = 0;
  std::size_t first = 0, count = 0;  ///< into Colliders::all
  bool moves = false;
  bool is_static = false;                 ///< in the coming substep: it stands, or sleeps
  bool was_static = false;                ///< in the substep before
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< corners of the box about those of its colliders [m]
  btBroadphaseProxy* proxy = nullptr;     ///< none: removed

  /// Whether it stood in the substep before, and still does.
  bool is_unchanged() const { return is_static && was_static; }
};

/// Two colliders that may touch within the substep.
struct ColliderPair {
  std::size_t a = 0, b = 0;  ///< into Colliders::all; a < b
};

class Colliders {
 public:
  Colliders();
  ~Colliders();

  std::vector<Collider> all;
  std::vector<ColliderGroup> groups;
  std::optional<std::size_t> floor;  ///< into `all`
  bool has_woken = false;            ///< one that rested in the substep before has woken
  /// Predicted motions of colliders, see add_predictions(): few.
  struct PredictedCollider {
    std::size_t index = 0;  ///< into `all`
    Collider collider;
  };
  std::vector<PredictedCollider> predicted;
  double gravity = 0;              ///< largest acceleration of free fall [m/s^2]
  dynamics::Team* team = nullptr;  ///< whose threads update poses; null: the caller's
  /// Entities that move in the substep by more than half of speculative_margin(): two of them may
  /// have an impact fast enough to matter.
  std::vector<int> fast_entities;

  bool is_static(const Collider& collider) const {
    return !collider.is_present || groups[collider.group].is_static;
  }

  void add_floor(const scene::Surface& surface);
  /// Adds the colliders of a body whose tree has valid kinematics.
  /// @throws std::bad_alloc; then nothing changes
  void add(const Body& body, const scene::Entity& entity, const dynamics::Tree& tree);
  /// Removes an entity's colliders. The last ones added are gone; others stay as places without a
  /// shape.
  void remove(std::size_t entity);
  /// Resets the poses of a body that was put elsewhere, and forgets all its pairs.
  void reset_poses(std::size_t entity, const dynamics::Tree& tree);

  /// Groups of an entity: groups are in the order of their entities.
  std::span<ColliderGroup> groups_of(std::size_t entity);

  /// Archives their state in the last substep.
  void archive(math::Archive& archive);

  /// Updates poses and velocities of all trees that are awake.
  void update_poses(const dynamics::System& system, double time_step);
  /// Updates some trees that are awake, for a part of the substep.
  void update_poses(const dynamics::System& system, double time_step, const TreeSet& active);
  /// Adds colliders of some trees whose motion differs from the known ones, and extends their
  /// reach. Until the next update_poses().
  /// @return  whether there are such: then there may be other pairs
  bool add_predictions(std::span<const int> trees, const dynamics::System& system,
                       double time_step);
  /// Whether a collider of an updated group may come near the floor within the substep.
  bool is_near_floor(std::size_t collider) const { return near_floor_[collider] != 0; }
  /// Moving groups that the last update_poses() updated, ascending.
  std::span<const std::size_t> updated_groups() const { return updated_groups_; }
  /// X_WS of a collider now.
  btTransform pose(const Collider& collider, const dynamics::System& system) const;
  /// Finds pairs whose boxes overlap, of which at least one moves. Pairs that were static in the
  /// substep before are left out, and the floor is in none.
  void find_pairs(std::vector<ColliderPair>& out);
  /// Finds pairs among some trees that were updated last, and with what stands.
  void find_pairs(std::vector<ColliderPair>& out, const TreeSet& active);
  /// Levels of the broad phase's trees, of the taller one.
  int tree_depth();

 private:
  struct Filter;
  struct Hits;
  void follow_anew() { passes_left_ = 2; }
  void follow(ColliderGroup& group, const dynamics::System& system);
  void update_changed(const dynamics::System& system, double time_step, bool shrinks);
  void set_pose(Collider& collider, const dynamics::Tree& tree) const;
  double update_poses(ColliderGroup& group, const dynamics::System& system, double time_step);
  void prefetch_after(const ColliderGroup& group, const dynamics::System& system) const;
  void enclose(ColliderGroup& group);
  void note_floor(std::size_t collider);
  bool fits_box(const ColliderGroup& group, double step, bool shrinks) const;
  void update_box(ColliderGroup& group, double step, bool shrinks);
  void insert(ColliderGroup& group, std::size_t index);
  void insert_new_groups();
  void find_pairs(const ColliderGroup& a, const ColliderGroup& b, std::vector<ColliderPair>& out);

  std::unique_ptr<Filter> filter_;
  btDbvtBroadphase broadphase_;
  std::size_t inserted_ = 0;    // groups that it knows
  std::vector<Bounds> bounds_;  // of a group's colliders
  std::vector<std::size_t> updated_groups_, hits_;
  std::vector<std::size_t> changed_;  // groups whose poses or boxes are updated
  struct Step {
    double length = 0;  // how far the group moves in the substep [m]
    bool fits_box = true;
  };
  std::vector<Step> steps_;               // of each of them
  std::vector<std::uint8_t> near_floor_;  // of each collider
  // Groups that move and do not rest: update_poses() looks at others only after a change.
  std::vector<std::size_t> followed_;
  int passes_left_ = 2;              // over all groups: was_static follows one after is_static
  std::uint64_t sleep_changes_ = 0;  // of the system, see System::sleep_changes()
  double margin_ = 0;                // with which the last poses were updated [m]
};

/// Speculative margin: distance at which pairs without velocity still get contacts in a substep
/// [m].
double speculative_margin(const Colliders& colliders, double time_step);

/// Takes memory for more items, so that push_back() can't throw.
template <class Item>
void make_room(std::vector<Item>& items, std::size_t more) {
  if (items.capacity() - items.size() < more) items.reserve(2 * items.size() + more);
}

/// Finds the points where two separate colliders first meet within a substep, each with its
/// distance along the normal at the impact. None if they pass each other. The method is
/// conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996, section 2.3).
/// Round surfaces are followed to their touch or closest approach, because their normal rotates.
/// @param near  distance that counts as an impact [m]
/// @param time  out: of the impact, from the substep's beginning [s]
contact::Manifold time_of_impact(const Collider& a, const Collider& b, double time_step,
                                 double near, double& time);

/// Rotation of a collider on a fixed base in a time [rad]; 0 of others.
double arm_rotation(const Collider& collider, double time);

/// Whether the normal of a contact rotates while two colliders approach: one of them is round, and
/// the other no plane.
bool has_rotating_normal(const Collider& a, const Collider& b);

/// Whether an impact of two colliders uses the levers of the touch: single bodies. Of jointed ones
/// all levers would change.
bool rebounds_at_touch_pose(const Collider& a, const Collider& b);

}  // namespace ziggurat::physics
