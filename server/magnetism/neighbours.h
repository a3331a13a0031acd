// SPDX-License-Identifier: MIT
#pragma once
// Which pairs of dipoles may be in range: a list with a skin, rebuilt when a dipole has moved
// more than half of it. Results do not depend on when it was rebuilt, see kernel.h.

#include <cstdint>
#include <vector>

#include "magnetism/kernel.h"

namespace ziggurat::magnetism {

class Neighbours {
 public:
  /// @param cutoff  pairs closer than this are always listed [m]; may be infinite
  explicit Neighbours(double cutoff);

  /// Brings the list up to date with the positions. Allocates only where a rebuild needs more room
  /// than any before.
  void update(const Dipoles& dipoles);

  /// False where all pairs are cheaper to go through than a list would be; pairs() is then empty.
  bool listed() const { return listed_; }

  /// Sorted and padded as Kernel::pairs needs it; valid until the next update.
  Pairs pairs() const { return {first_.data(), second_.data(), first_.size()}; }

  std::size_t rebuilds() const { return rebuilds_; }

 private:
  /// A cell's place in the grid's table. The table wraps around, so that it is small however far a
  /// dipole has strayed: cells far apart may share a place, cells next to each other never do.
  struct Grid {
    Row origin;
    double inverse_edge;                   // [1/m]
    std::uint32_t mask_x, mask_y, mask_z;  // places per axis - 1, powers of two, at least four
    std::uint32_t shift_y, shift_z;
  };

  bool moved(const Dipoles& dipoles) const;
  void rebuild(const Dipoles& dipoles);
  void fill_grid(const Dipoles& dipoles);
  bool list_by_grid(const Dipoles& dipoles);
  void gather_candidates(std::uint32_t place);
  void list_by_comparison(const Dipoles& dipoles);
  void pad(std::size_t count);

  double reach_;      // cutoff + skin [m]
  double half_skin_;  // [m]
  bool listed_ = false;
  std::size_t rebuilds_ = 0;
  std::vector<Row> built_at_;  // positions at the last rebuild
  std::vector<std::uint32_t> first_, second_;

  // Working space of rebuild().
  Grid grid_{};
  std::vector<std::uint32_t> places_;   // of every dipole
  std::vector<std::uint32_t> starts_;   // of every place in members_
  std::vector<std::uint32_t> members_;  // dipoles by place
  std::vector<Row> member_rows_;        // their positions; w: group
  std::vector<Row> candidate_rows_;     // around one place
  std::vector<std::uint32_t> candidates_;
  std::vector<std::uint32_t> found_;                  // partners, dipole after dipole
  std::vector<std::uint32_t> found_from_, found_to_;  // of every dipole in found_
};

}  // namespace ziggurat::magnetism
