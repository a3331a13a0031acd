#pragma once
// What can touch: the shapes of all parts, where they are, and which of them come near each other
// within a substep (Bullet's trees of boxes).

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/system.h"
#include "physics/bodies.h"
#include "physics/contact/shapes.h"
#include "physics/newton/tree_set.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Along the world's axes.
struct Bounds {
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< corners [m]
};

/// What each substep reads and writes comes first, and fills four lines of the cache.
struct alignas(64) Collider {
  static constexpr std::size_t floor = static_cast<std::size_t>(-1);

  // Of the coming substep:
  btTransform pose = btTransform::getIdentity();  ///< X_WS
  btVector3 velocity{0, 0, 0};                    ///< of the shape's centre [m/s]
  btVector3 angular_velocity{0, 0, 0};            ///< [rad/s]
  double reach = 0;                               ///< how far its surface may come [m]

  double radius = 0;           ///< of the sphere about the shape's centre that holds it [m]
  btVector3 half{0, 0, 0};     ///< half extents of the box about it and its centre, in its axes [m]
  std::size_t entity = floor;  ///< its number, and that of its tree
  std::uint32_t part = 0;      ///< into Body::parts
  bool centred = true;         ///< in_part is the identity
  bool moves = false;
  bool present = false;  ///< otherwise removed; the floor is not, either
  bool rolls = false;    ///< has wheels: does not rub on what is below or above it

  std::size_t group = 0;  ///< into the broad phase's groups
  std::size_t link = 0;   ///< into Body::links
  bool swings = false;    ///< on joints from something that stands: its centre moves on a circle
  bool is_alone = false;  ///< the only part of its entity, which moves freely, and its centre is the part's
  scene::Surface surface;
  contact::Shape shape;
  btTransform in_part = btTransform::getIdentity();  ///< X_PS

  Bounds bounds() const;  ///< of it and its reach
  void archive(math::Archive& archive);
};

/// What the broad phase sees as one box: all colliders of an entity that moves, or one that stands.
struct ColliderGroup {
  std::size_t entity = 0;
  std::size_t first = 0, count = 0;  ///< into Colliders::all
  bool moves = false;
  bool rests = false;                     ///< in the coming substep: it stands, or sleeps
  bool rested = false;                    ///< in the substep before
  btVector3 low{0, 0, 0}, high{0, 0, 0};  ///< corners of the box about those of its colliders [m]
  btBroadphaseProxy* proxy = nullptr;     ///< none: removed

  /// It is as it was in the substep before.
  bool unchanged() const { return rests && rested; }
};

/// Two colliders that may touch within the substep.
struct Near {
  std::size_t a = 0, b = 0;  ///< into Colliders::all; a < b
};

class Colliders {
 public:
  Colliders();
  ~Colliders();

  std::vector<Collider> all;
  std::vector<ColliderGroup> groups;
  std::optional<std::size_t> floor;  ///< into `all`
  bool woke = false;                 ///< one that rested in the substep before does no more
  /// As widen() found them, one after the other: few.
  struct Thrown {
    std::size_t index = 0;  ///< into `all`
    Collider collider;
  };
  std::vector<Thrown> thrown;
  double gravity = 0;  ///< what pulls all that falls [m/s^2]
  /// Entities that move by more than half of what does not move yet may come, see least_reach(): two of them may strike each other so fast.
  std::vector<int> fast;

  bool rests(const Collider& collider) const {
    return !collider.present || groups[collider.group].rests;
  }

  void add_floor(const scene::Surface& surface);
  /// Those of a body whose tree is placed.
  /// @throws std::bad_alloc; then nothing changes
  void add(const Body& body, const scene::Entity& entity, const dynamics::Tree& tree);
  /// The last ones added are gone; others stay as places without a shape.
  void remove(std::size_t entity);
  /// Where a body was put, with all its pairs forgotten.
  void moved(std::size_t entity, const dynamics::Tree& tree);

  /// The groups of an entity, which stand together: groups are in the order of their entities.
  std::span<ColliderGroup> groups_of(std::size_t entity);

  /// Where they were in the last substep.
  void archive(math::Archive& archive);

  /// Takes the poses and motions of all trees that are awake.
  void follow(const dynamics::System& system, double length);
  /// Those of some trees that are awake, for a part of the substep.
  void follow(const dynamics::System& system, double length, const TreeSet& chosen);
  /// Notes which colliders of some trees move otherwise now than is known of them, and widens their reach. Until the next follow().
  /// @return  whether there are such: then others may be near
  bool widen(std::span<const int> trees, const dynamics::System& system, double length);
  /// Groups that move and whose poses the last follow() took, ascending.
  std::span<const std::size_t> followed() const { return followed_; }
  /// X_WS of a collider now.
  btTransform pose(const Collider& collider, const dynamics::System& system) const;
  /// Pairs whose boxes overlap, of which at least one moves, without those that are as they were in
  /// the substep before. The floor is in none.
  void find_near(std::vector<Near>& out);
  /// Those among some trees that were followed last, and with what stands.
  void find_near(std::vector<Near>& out, const TreeSet& chosen);
  /// Levels of the broad phase's trees, of the taller one.
  int depth();

 private:
  struct Filter;
  struct Hits;
  void place(Collider& collider, const dynamics::Tree& tree) const;
  double follow(ColliderGroup& group, const dynamics::System& system, double length);
  void fetch_after(const ColliderGroup& group, const dynamics::System& system) const;
  void enclose(ColliderGroup& group);
  void keep_in_box(ColliderGroup& group, double step, bool shrinks);
  void insert(ColliderGroup& group, std::size_t index);
  void settle();
  void find_near(const ColliderGroup& a, const ColliderGroup& b, std::vector<Near>& out);

  std::unique_ptr<Filter> filter_;
  btDbvtBroadphase broadphase_;
  std::size_t settled_ = 0;  // groups that it knows
  std::vector<Bounds> bounds_;  // of a group's colliders
  std::vector<std::size_t> followed_, hits_;
};

/// How far a surface may come within a substep without moving yet [m].
double least_reach(const Colliders& colliders, double length);

}  // namespace ziggurat::physics
