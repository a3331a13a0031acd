// SPDX-License-Identifier: MIT
#pragma once
// Magnets that turn freely in their socket (a leaf link on a spherical joint at its centre of
// mass): their orientation is a state of its own, relaxed towards the local field, because the
// bare rigid-body equation would need substeps below 0.2 ms. docs/magnetism.md derives it.

#include <cstdint>
#include <vector>

#include "magnetism/dipole.h"
#include "magnetism/kernel.h"

namespace ziggurat::magnetism {

using math::Quaternion;

struct RelaxationOptions {
  double friction = 2e-7;  ///< c of  c dtheta/dt = -m B sin(theta) [N m s]
  unsigned passes = 2;     ///< per substep, alternately forwards and backwards
};

/// The exact solution of c dtheta/dt = -m B sin(theta) after a time, for a direction in a field at
/// rest: stable for any time, and never against the field. A direction opposite to the field
/// leaves the balance towards a fixed perpendicular.
/// @param direction  unit
/// @param field      flux density [T]
/// @param rate       m / c [1 / (T s)]
/// @param time       [s]
/// @returns the new direction, unit
Vector3 turned(const Vector3& direction, const Vector3& field, double rate, double time);

/// The shortest rotation from one unit vector to another.
Quaternion shortest_rotation(const Vector3& from, const Vector3& to);

/// A small tilt, different for every index, that breaks exact symmetries: rows of magnets in
/// unstable balance would else never leave it.
/// @param direction  unit
/// @returns unit, about 1e-3 rad away
Vector3 tilted(const Vector3& direction, std::size_t index);

/// Who acts on each freely turning magnet; rebuilt with the neighbour list.
class Partners {
 public:
  /// @param free  the freely turning dipoles, ascending
  void list(const Pairs& pairs, const std::vector<std::uint32_t>& free, std::size_t dipoles);
  /// Every dipole acts on every other one.
  void list_all(std::size_t dipoles);

  const std::uint32_t* begin(std::size_t dipole) const {
    return indices_.data() + (all_ ? 0 : starts_[dipole]);
  }
  /// A multiple of four.
  std::size_t count(std::size_t dipole) const {
    return all_ ? indices_.size() : starts_[dipole + 1] - starts_[dipole];
  }

 private:
  bool all_ = false;
  std::vector<std::uint32_t> starts_;  // of every dipole in indices_, all zero lengths for the rest
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> fill_;
};

/// Turns the moments of the free dipoles, one after the other, each in the field of the others as
/// they are by then; positions stay.
/// @param moments   of the dipoles, changed in place for the free ones
/// @param external  a field to add to that of the partners, per dipole [T]
void relax(const Kernel& kernel, const Dipoles& dipoles, Row* moments, const Row* external,
           const std::vector<std::uint32_t>& free, const Partners& partners, const Range& range,
           double dt, const RelaxationOptions& options);

}  // namespace ziggurat::magnetism
