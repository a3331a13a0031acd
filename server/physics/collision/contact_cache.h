// SPDX-License-Identifier: MIT
#pragma once
// Contact cache: contact points of a substep, with the impulses of the last substep.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "physics/bodies/link_contact.h"
#include "physics/collision/collide.h"
#include "physics/collision/colliders.h"
#include "physics/collision/pair_lists.h"
#include "physics/solver/constraint.h"

namespace ziggurat::physics {

/// Key of a pair of colliders.
inline std::uint64_t key_of(std::size_t a, std::size_t b) { return std::uint64_t{a} << 32 | b; }

/// Common data of all contacts of a pair, at the present poses.
/// @param count  of its points
dynamics::ContactPoint contact_of(const Collider& a, const Collider& b, const math::Vector3& normal,
                                  int count);

class ContactCache {
 public:
  explicit ContactCache(Colliders& colliders) : colliders_(colliders) {}

  /// Pairs are collided by a team's threads; null: by the caller's, as at first.
  void set_team(dynamics::Team* team);

  /// Trees of the last find_contacts() that rotate far until their impact.
  std::vector<dynamics::RotationUntilImpact> rotations_until_impact;

  /// Finds contacts of the coming substep, with the impulses of the last one. Static pairs are left
  /// out, because they do nothing while both sides rest.
  std::span<dynamics::ContactPoint> find_contacts(double time_step);
  /// Adds the contacts of static pairs: for substeps in which something wakes.
  std::span<dynamics::ContactPoint> add_resting_contacts();
  /// Finds contacts for a part of the substep in which only some trees move, all of them awake:
  /// among them, and with what stands.
  /// @param force_share  of the substep's forces that act in the part
  std::span<dynamics::ContactPoint> find_contacts(double time_step, const TreeSet& active,
                                                  double force_share);
  /// Begins the parts of a set of trees; to be called before the first one.
  void begin_parts(const TreeSet& active);
  /// Keeps the contacts of a set of trees only, until the next find_contacts().
  std::span<dynamics::ContactPoint> keep_contacts(const TreeSet& active);
  /// Pairs of the last find_contacts().
  std::span<const ColliderPair> near_pairs() const { return near_pairs_; }
  /// Stores the impulses that the solver has written.
  /// @param more  parts of the substep are still to come
  void store_impulses(bool more = false);
  /// Stores the impulses of a prediction: the next find_contacts() begins from them.
  void store_estimates();
  /// Stores the impulses of an impact that the solver has written: for list_contacts(), not for the
  /// next solution.
  void add_impact_impulses();
  /// Finds new overlaps with static colliders: of bodies that rotated far in the substep, or are
  /// off their predicted positions.
  std::span<dynamics::ContactPoint> find_new_overlaps(const dynamics::System& system);
  /// Forgets an entity's pairs, before it is removed or moved; wakes bodies that touched it.
  void forget(std::size_t entity, dynamics::System& system);

  /// Lists all touching pairs, in ascending order.
  void list_contacts(std::vector<LinkContact>& out) const;

  /// Archives the cache. @pre the colliders have been read
  friend void archive_fields(math::Archive& archive, ContactCache& contacts);

 private:
  static constexpr int most_points = 8;    // of a pair; 4 unless it tumbles
  static constexpr std::size_t ahead = 8;  // contacts whose memory is asked for
  struct CachedPoint {
    math::Vector3 on_a{0, 0, 0}, on_b{0, 0, 0};  // in the colliders' frames [m]
    math::Vector3 point{0, 0, 0};
    math::Vector3 impulse{0, 0, 0}, angular_impulse{0, 0, 0};  // for all forces of a substep
    double gap = 0;
    bool carried = false;  // it had an impulse when it was stepped last
    void archive(math::Archive& archive);
  };
  /// Points of a pair: few, unless it tumbles.
  class CachedPoints {
   public:
    CachedPoint& operator[](int i) { return i < few ? first_[i] : (*more_)[i - few]; }
    const CachedPoint& operator[](int i) const { return i < few ? first_[i] : (*more_)[i - few]; }
    /// Takes memory when a pair has many points for the first time.
    void make_room(int count) {
      if (count > few && !more_) more_ = std::make_unique<More>();
    }

   private:
    static constexpr int few = 4;
    using More = std::array<CachedPoint, most_points - few>;
    std::array<CachedPoint, few> first_;
    std::unique_ptr<More> more_;
  };
  // Begins a line of the cache.
  struct alignas(64) CachedPair {
    static constexpr std::size_t prefetched_bytes = 384;  // with two points [bytes]
    std::uint32_t a = 0, b = 0;                           // colliders
    bool live = false;
    bool covers_internal_edge = false;  // it covers internal edges, so its contacts are kept
    bool is_static = false;             // both sides rested when it was seen last
    unsigned last_substep = 0;          // the substep in which it was near last
    unsigned last_part = 0;             // likewise, counting parts as substeps
    int count = 0;
    math::Vector3 normal{0, 0, 1};
    math::Vector3 earlier_impulse{0, 0, 0};  // impulse in earlier parts of the substep [N s]
    double force_share = 1;                  // of the substep's forces, that acted in its last part
    CachedPoints points;
    void archive(math::Archive& archive);
  };

  /// A near pair, and its contacts.
  struct ListedPair {
    int pair = 0;                  // its number
    int first = 0, count = 0;      // of its contacts
    bool rested = false;           // both sides rested when it was seen before
    bool rests = false;            // they do
    bool has_static_side = false;  // then its overlap may be recovered
    bool has_no_contact = false;   // none was found
    bool is_off = false;           // a side is off its predicted pose
    RotationOutcome rotation;
  };

  int place_of(std::size_t a, std::size_t b, int& place);
  using Points = std::array<CachedPoint, most_points>;
  void list_pairs();
  void begin_pair(ListedPair& listed);
  void collide_pairs(double time_step);
  void collide_pair(std::size_t index, Points& memory);
  void match_points(const contact::Manifold& found, CachedPair& pair, Points& memory);
  void place_contacts(ListedPair& listed);
  void write_contacts(const ListedPair& listed);
  bool is_off_prediction(const ListedPair& listed, const dynamics::System& system) const;
  bool is_inside_neighbour(const Collider& cover, const CachedPair& hidden, std::size_t mover,
                           const btVector3& up, btScalar height, const btVector3& point);
  bool drops_internal_edge(CachedPair& seen, CachedPair& hidden, std::size_t mover);
  void list_supports(const CachedPair& pair);
  void list_supports();
  void drop_internal_edges();
  template <class IsKept>
  void keep_if(IsKept is_kept);
  void drop_pair(std::size_t number);
  void drop_separated_pairs();
  void check_pairs(const math::Archive& archive) const;

  Colliders& colliders_;
  std::vector<CachedPair> pairs_;  // [0] is none
  std::vector<int> unused_;
  std::size_t live_ = 0, resting_ = 0;  // pairs
  std::size_t awake_ = 0;               // that the last collide_pairs() saw
  std::unordered_map<std::uint64_t, int>
      places_;               // of pairs by their colliders; not with the floor
  double slack_ = 0;         // speculative margin of the coming substep or part [m]
  double together_gap_ = 0;  // gap above which touching surfaces meet later in the substep [m]
  double time_step_ = 0;     // of the coming substep or part [s]
  double force_share_ = 1;   // of a substep's forces, that acts in the coming one
  unsigned substep_ = 0, part_ = 0;                 // how many there were; part_: of both
  std::vector<ListedPair> listed_, listed_before_;  // by the last find_contacts(), the one before
  std::vector<ColliderPair> near_pairs_;
  std::vector<int> floor_pairs_;       // of each collider
  PairLists pairs_of_collider_;        // of all colliders but the floor
  std::vector<int> forgotten_;         // pairs, in forget()
  std::vector<int> neighbours_;        // of a collider, in is_inside_neighbour()
  std::vector<CachedPair*> carriers_;  // of the contacts that drops_internal_edge() looks at
  std::vector<dynamics::ContactPoint> contacts_;
  std::size_t contact_count_ = 0;  // of them that have been placed
  dynamics::Team* team_ = nullptr;
  std::vector<Points> previous_points_{1};        // of each thread: of its pair, a substep ago
  std::vector<dynamics::ContactPoint> overlaps_;  // that were found last
  /// A moving collider on a base, a body that may have several colliders beside each other.
  struct Support {
    std::size_t mover = 0;   // a collider
    std::size_t entity = 0;  // of the base; Collider::floor: all that stands
    std::size_t part = 0;    // of it
    std::size_t base = 0;    // its collider: pair numbers depend on the history
    int pair = 0;
    auto operator<=>(const Support&) const = default;
  };
  std::vector<Support> supports_;
};

/// Keeps the contacts of some pairs.
template <class IsKept>
void ContactCache::keep_if(IsKept is_kept) {
  int kept = 0;
  for (ListedPair& listed : listed_) {
    const int from = std::exchange(listed.first, kept);
    if (listed.count > 0 && !is_kept(pairs_[listed.pair])) listed.count = 0;
    if (from != kept) std::copy_n(contacts_.begin() + from, listed.count, contacts_.begin() + kept);
    kept += listed.count;
  }
  contact_count_ = static_cast<std::size_t>(kept);
  contacts_.resize(contact_count_);
}

}  // namespace ziggurat::physics
