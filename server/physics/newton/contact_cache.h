#pragma once
// Contact points of a substep for dynamics/, and what is remembered of them.

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "dynamics/constraint.h"
#include "physics/newton/colliders.h"
#include "physics/newton/pair_lists.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

/// Of a pair of colliders.
inline std::uint64_t key_of(std::size_t a, std::size_t b) { return std::uint64_t{a} << 32 | b; }

/// What all contacts of a pair have in common, where they are now.
/// @param count  of its points
dynamics::ContactPoint contact_of(const Collider& a, const Collider& b, const math::Vector3& normal,
                         int count);

class ContactCache {
 public:
  explicit ContactCache(Colliders& colliders) : colliders_(colliders) {}

  /// Trees of the last find_contacts() that swing far until they meet something.
  std::vector<dynamics::RotationUntilImpact> rotations_until_impact;

  /// Contacts of the coming substep, with the impulses of the last one; without those of pairs that
  /// both rest, which do nothing as long as both do.
  std::span<dynamics::ContactPoint> find_contacts(double time_step);
  /// Those and the others: where something wakes in the substep.
  std::span<dynamics::ContactPoint> add_resting_contacts();
  /// The same for a part of the substep in which only some trees move, all of them awake: contacts
  /// among them, and with what stands.
  /// @param share  of the substep's forces that act in the part
  std::span<dynamics::ContactPoint> find_contacts(double time_step, const TreeSet& active, double force_share);
  /// To be called before the first part of a set of trees.
  void begin_parts(const TreeSet& active);
  /// Leaves out the contacts of all others, until the next find_contacts().
  std::span<dynamics::ContactPoint> keep_contacts(const TreeSet& active);
  /// Which colliders were near each other at the last find_contacts().
  std::span<const ColliderPair> near_pairs() const { return near_pairs_; }
  /// Notes the impulses that dynamics/ has written to them.
  /// @param more  parts of the substep are still to come
  void store_impulses(bool more = false);
  /// Contacts between what stands and bodies that turned far in the substep, or are not where their velocities led, where they
  /// overlap now.
  std::span<dynamics::ContactPoint> find_new_overlaps(const dynamics::System& system);
  /// Forgets what touched an entity, before it is removed or moved; wakes what rested there.
  void forget(std::size_t entity, dynamics::System& system);

  /// What touches, in ascending order.
  void list_contacts(std::vector<LinkContact>& out) const;

  /// What is remembered. @pre the colliders have been read
  friend void archive_fields(math::Archive& archive, ContactCache& contacts);

 private:
  static constexpr int most_points = 8;  // of a pair; 4 unless it tumbles
  static constexpr std::size_t ahead = 8;  // contacts whose memory is asked for
  struct CachedPoint {
    math::Vector3 on_a{0, 0, 0}, on_b{0, 0, 0};  // in the colliders' frames [m]
    math::Vector3 point{0, 0, 0};
    math::Vector3 impulse{0, 0, 0}, angular_impulse{0, 0, 0};  // for all forces of a substep
    double gap = 0;
    void archive(math::Archive& archive);
  };
  // Begins a line of the cache.
  struct alignas(64) CachedPair {
    static constexpr std::size_t prefetched_bytes = 384;  // with two points [bytes]
    std::uint32_t a = 0, b = 0;  // colliders
    bool live = false;
    bool covers_internal_edge = false;      // contacts of others were dropped because of it
    bool is_static = false;       // both sides did in the substep in which it was seen last
    unsigned last_substep = 0;        // the substep in which it was near last
    unsigned last_part = 0;         // likewise, counting parts as substeps
    int count = 0;
    math::Vector3 normal{0, 0, 1};
    math::Vector3 earlier_impulse{0, 0, 0};  // impulse in earlier parts of the substep [N s]
    double force_share = 1;                // of the substep's forces, that acted in its last part
    std::array<CachedPoint, most_points> points;
    void archive(math::Archive& archive);
  };

  CachedPair& pair_of(std::size_t a, std::size_t b, int& place);
  void collide_pairs(double time_step);
  void collide_pair(CachedPair& pair, double time_step);
  void match_points(const contact::Manifold& found, CachedPair& pair, double time_step);
  void append_contacts(const CachedPair& pair);
  bool is_inside_neighbour(const Collider& cover, const CachedPair& hidden, std::size_t mover, const btVector3& up, btScalar height,
                      const btVector3& point);
  bool drops_internal_edge(CachedPair& seen, CachedPair& hidden, std::size_t mover);
  void list_supports(const CachedPair& pair);
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
      places_;                         // of pairs by their colliders; not with the floor
  double together_gap_ = 0;                   // what is farther apart and touches meets later in the substep [m]
  double time_step_ = 0;                  // of the coming substep or part [s]
  double force_share_ = 1;                   // of a substep's forces, that acts in the coming one
  unsigned substep_ = 0, part_ = 0;    // how many there were; part_: of both
  std::vector<int> pairs_of_part_, pairs_of_previous_part_;  // pairs, by the last find_contacts() and the one before
  std::vector<ColliderPair> near_pairs_;
  std::vector<int> floor_pairs_;  // of each collider
  PairLists pairs_of_collider_;               // of all colliders but the floor
  std::vector<int> forgotten_;    // pairs, in forget()
  std::vector<int> neighbours_;   // of a collider, in is_inside_neighbour()
  std::vector<CachedPair*> carriers_;   // of the contacts that drops_internal_edge() looks at
  std::vector<dynamics::ContactPoint> contacts_;
  /// Where a contact is remembered.
  struct CacheIndex {
    int pair = 0, point = 0;
  };
  std::vector<CacheIndex> cache_indices_;                   // of each contact
  std::array<CachedPoint, most_points> previous_points_;  // of the pair under way, a substep ago
  /// A pair one side of which stands and the other one turns far in the substep, or may be struck so that it does.
  struct OverlapCandidate {
    std::size_t pair = 0;
    bool has_no_contact = false;  // no contact was found
    bool rotates_far = false;  // without being struck
  };
  std::vector<OverlapCandidate> overlap_candidates_;
  std::vector<dynamics::ContactPoint> overlaps_;     // of these
  /// A pair of a collider that moves and one of a body that has, or may have, others beside it.
  struct Support {
    std::size_t mover = 0;   // a collider
    std::size_t entity = 0;  // of the base; Collider::floor: all that stands
    std::size_t part = 0;    // of it
    std::size_t base = 0;      // its collider: places of pairs depend on others that were there
    int pair = 0;
    auto operator<=>(const Support&) const = default;
  };
  std::vector<Support> supports_;
};

/// Leaves the contacts of some pairs.
template <class IsKept>
void ContactCache::keep_if(IsKept is_kept) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cache_indices_.size(); ++i) {
    if (!is_kept(pairs_[cache_indices_[i].pair])) continue;
    contacts_[kept] = contacts_[i];
    cache_indices_[kept++] = cache_indices_[i];
  }
  contacts_.resize(kept);
  cache_indices_.resize(kept);
}

}  // namespace ziggurat::physics
