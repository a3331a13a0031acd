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
dynamics::ContactPoint law_of(const Collider& a, const Collider& b, const math::Vector3& normal,
                         int count);

class Contacts {
 public:
  explicit Contacts(Colliders& colliders) : colliders_(colliders) {}

  /// Trees of the last find() that swing far until they meet something.
  std::vector<dynamics::RotationUntilImpact> swings;

  /// Contacts of the coming substep, with the impulses of the last one; without those of pairs that
  /// both rest, which do nothing as long as both do.
  std::span<dynamics::ContactPoint> find(double length);
  /// Those and the others: where something wakes in the substep.
  std::span<dynamics::ContactPoint> add_resting();
  /// The same for a part of the substep in which only some trees move, all of them awake: contacts
  /// among them, and with what stands.
  /// @param share  of the substep's forces that act in the part
  std::span<dynamics::ContactPoint> find(double length, const TreeSet& chosen, double share);
  /// To be called before the first part of a set of trees.
  void choose(const TreeSet& chosen);
  /// Leaves out the contacts of all others, until the next find().
  std::span<dynamics::ContactPoint> keep(const TreeSet& chosen);
  /// Which colliders were near each other at the last find().
  std::span<const Near> near() const { return near_; }
  /// Notes the impulses that dynamics/ has written to them.
  /// @param more  parts of the substep are still to come
  void remember(bool more = false);
  /// Contacts between what stands and bodies that turned far in the substep, or are not where their velocities led, where they
  /// overlap now.
  std::span<dynamics::ContactPoint> find_turned(const dynamics::System& system);
  /// Forgets what touched an entity, before it is removed or moved; wakes what rested there.
  void forget(std::size_t entity, dynamics::System& system);

  /// What touches, in ascending order.
  void tell(std::vector<Contact>& out) const;

  /// What is remembered. @pre the colliders have been read
  friend void archive_fields(math::Archive& archive, Contacts& contacts);

 private:
  static constexpr int most_points = 8;  // of a pair; 4 unless it tumbles
  static constexpr std::size_t ahead = 8;  // contacts whose memory is asked for
  struct Remembered {
    math::Vector3 on_a{0, 0, 0}, on_b{0, 0, 0};  // in the colliders' frames [m]
    math::Vector3 point{0, 0, 0};
    math::Vector3 impulse{0, 0, 0}, angular_impulse{0, 0, 0};  // for all forces of a substep
    double gap = 0;
    void archive(math::Archive& archive);
  };
  // Begins a line of the cache.
  struct alignas(64) Pair {
    static constexpr std::size_t beginning = 384;  // with two points [bytes]
    std::uint32_t a = 0, b = 0;  // colliders
    bool live = false;
    bool covers = false;      // contacts of others were dropped because of it
    bool rests = false;       // both sides did in the substep in which it was seen last
    unsigned seen = 0;        // the substep in which it was near last
    unsigned met = 0;         // likewise, counting parts as substeps
    int count = 0;
    math::Vector3 normal{0, 0, 1};
    math::Vector3 earlier{0, 0, 0};  // impulse in earlier parts of the substep [N s]
    double share = 1;                // of the substep's forces, that acted in its last part
    std::array<Remembered, most_points> points;
    void archive(math::Archive& archive);
  };

  Pair& pair_of(std::size_t a, std::size_t b, int& place);
  void meet_all(double length);
  void meet(Pair& pair, double length);
  void add(const contact::Contacts& found, Pair& pair, double length);
  void emit(const Pair& pair);
  bool is_inside_base(const Collider& cover, const Pair& hidden, std::size_t mover, const btVector3& up, btScalar height,
                      const btVector3& point);
  bool drops(Pair& seen, Pair& hidden, std::size_t mover);
  void note_bases(const Pair& pair);
  void drop_hidden();
  template <class IsKept>
  void keep_if(IsKept is_kept);
  void drop(std::size_t number);
  void drop_unseen();
  void check_pairs(const math::Archive& archive) const;

  Colliders& colliders_;
  std::vector<Pair> pairs_;  // [0] is none
  std::vector<int> unused_;
  std::size_t live_ = 0, resting_ = 0;  // pairs
  std::size_t awake_ = 0;               // that the last meet_all() saw
  std::unordered_map<std::uint64_t, int>
      places_;                         // of pairs by their colliders; not with the floor
  double apart_ = 0;                   // what is farther apart and touches meets later in the substep [m]
  double length_ = 0;                  // of the coming substep or part [s]
  double share_ = 1;                   // of a substep's forces, that acts in the coming one
  unsigned substep_ = 0, part_ = 0;    // how many there were; part_: of both
  std::vector<int> met_, met_before_;  // pairs, by the last find() and the one before
  std::vector<Near> near_;
  std::vector<int> floor_pairs_;  // of each collider
  PairLists lists_;               // of all colliders but the floor
  std::vector<int> forgotten_;    // pairs, in forget()
  std::vector<int> neighbours_;   // of a collider, in is_inside_base()
  std::vector<Pair*> carriers_;   // of the contacts that drops() looks at
  std::vector<dynamics::ContactPoint> contacts_;
  /// Where a contact is remembered.
  struct Owner {
    int pair = 0, point = 0;
  };
  std::vector<Owner> owners_;                   // of each contact
  std::array<Remembered, most_points> before_;  // of the pair under way, a substep ago
  /// A pair one side of which stands and the other one turns far in the substep, or may be struck so that it does.
  struct Turned {
    std::size_t pair = 0;
    bool flies = false;  // no contact was found
    bool turns = false;  // without being struck
  };
  std::vector<Turned> turned_;
  std::vector<dynamics::ContactPoint> overlaps_;     // of these
  /// A pair of a collider that moves and one of a body that has, or may have, others beside it.
  struct OnBase {
    std::size_t mover = 0;   // a collider
    std::size_t entity = 0;  // of the base; Collider::floor: all that stands
    std::size_t part = 0;    // of it
    std::size_t on = 0;      // its collider: places of pairs depend on others that were there
    int pair = 0;
    auto operator<=>(const OnBase&) const = default;
  };
  std::vector<OnBase> on_bases_;
};

/// Leaves the contacts of some pairs.
template <class IsKept>
void Contacts::keep_if(IsKept is_kept) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    if (!is_kept(pairs_[owners_[i].pair])) continue;
    contacts_[kept] = contacts_[i];
    owners_[kept++] = owners_[i];
  }
  contacts_.resize(kept);
  owners_.resize(kept);
}

}  // namespace ziggurat::physics
