// SPDX-License-Identifier: MIT
#pragma once
// The inner loops over pairs of dipoles, four pairs at a time. Sources are kept as a structure of
// arrays of 32-byte rows (positions, moments, forces, fields), one row per dipole. They are
// transposed in registers, so that a register holds one coordinate of four dipoles.
//
// Same bits everywhere: every lane does the arithmetic of the scalar formula in the same order
// (add, multiply, divide, square root: all correctly rounded; no fused operation). Four lanes are
// one unit whatever the register width. Every dipole receives its partners' contributions one by
// one in ascending order of the partner's index. A pair out of range contributes a zero, which
// changes no bit of a sum that started at +0. So results do not depend on the instruction set, the
// history of list rebuilds, and the choice between list and all pairs.

#include <cstddef>
#include <cstdint>

namespace ziggurat::magnetism {

/// Four doubles: three coordinates and one number more.
struct alignas(32) Row {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 0;
};

/// Dipoles. All arrays have padded_rows(count) rows; the rows from count on have zero moments.
struct Dipoles {
  const Row* positions;  ///< x y z in the world [m]; w: core radius [m], see Range::minimum
  const Row* moments;    ///< x y z in the world [A m^2]; w: group, pairs of one group are left out
  std::size_t count;
};

/// Rows needed for count dipoles: at least one beyond, a multiple of four.
constexpr std::size_t padded_rows(std::size_t count) { return (count / 4 + 1) * 4; }

/// Sums over partners, one row per dipole; the caller sets them to zero. w is left alone.
struct Sums {
  Row* forces;  ///< [N]
  Row* fields;  ///< flux density of the others at the dipole [T]
};

/// Which separations count, and how.
struct Range {
  double maximum;  ///< pairs farther apart than this contribute nothing [m]; may be infinite
  double
      taper_start;  ///< the energy is faded out smoothly from here to maximum [m]; >= maximum: no
  double minimum;   ///< > 0 [m]; separations below it, or below the sum of the cores, count as that
};

/// Pairs (first[k], second[k]) with first < second, sorted by first, then second; padded to a
/// multiple of four with pairs of the row Dipoles::count.
struct Pairs {
  const std::uint32_t* first;
  const std::uint32_t* second;
  std::size_t count;  ///< with padding
};

/// Weighted points that stand for one magnet, in its shape's axes from its centre; arrays padded to
/// a multiple of four with zero weights.
struct Points {
  const double* x;  ///< [m]
  const double* y;
  const double* z;
  const double* weight;  ///< share of the moment
  std::size_t count;     ///< with padding
  double axes[9];        ///< rotation from the shape's axes to the world, row by row
};

/// One dipole in the field of a magnet made of points: x y z of Row.
struct PointResult {
  Row force;  ///< on the dipole [N]
  Row field;  ///< at the dipole [T]
};

struct Kernel {
  const char* name;
  /// Adds the pairs listed to the sums.
  void (*pairs)(const Dipoles&, const Pairs&, const Range&, const Sums&);
  /// Adds all pairs of different groups to the sums: the same bits as a list of all of them.
  void (*all_pairs)(const Dipoles&, const Range&, const Sums&);
  /// The field at one dipole of the partners listed (any order; entries may be out of range, of the
  /// dipole's own group, or Dipoles::count): x y z of the row [T].
  /// @param count  of partners, a multiple of four
  Row (*field_at)(const Dipoles&, std::size_t dipole, const std::uint32_t* partners,
                  std::size_t count, const Range&);
  /// @param moment      of the dipole [A m^2]
  /// @param source      moment of the whole magnet [A m^2]
  /// @param separation  dipole minus centre of the magnet [m]
  PointResult (*points)(const Row& moment, const Row& source, const Row& separation,
                        const Points& points);
};

/// For any processor.
const Kernel& baseline_kernel();
/// The widest one that this processor has.
const Kernel& best_kernel();

/// Nothing where the processor has no AVX2.
const Kernel* avx2_kernel();

}  // namespace ziggurat::magnetism
