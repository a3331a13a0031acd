// SPDX-License-Identifier: MIT
#pragma once
// Stiff pairs of magnets, whose forces change too fast for one substep, and the number of parts
// that they need. docs/magnetism.md derives the limits.

#include <cstdint>
#include <optional>

#include "magnetism/field.h"
#include "math/archive.h"

namespace ziggurat::physics {

/// Two bodies bonded by fixed magnets may tumble freely without gaining energy while substep * rate
/// (magnetism/stiffness.h) is below this. Measured: see docs/magnetism.md.
constexpr double safe_divided = 64;

/// Need of a pair, or of all pairs of a carrier, in a substep.
struct Need {
  double misplaced = 0;      ///< energy, if it is taken as a whole, over that of a bond
  double parts_squared = 0;  ///< of the number into which it should be divided, if it must be
  double fewest_parts = 0;   ///< and never into fewer

  Need& operator+=(const Need& other);
  void archive(math::Archive& archive);
};

/// Carrier of magnets: the part that they move with.
struct Carrier {
  std::size_t entity = 0;
  std::size_t part = 0;
  double inverse_mass = 0;     ///< [1/kg]; 0: it stands
  double inverse_inertia = 0;  ///< the largest principal one [1/(kg m^2)]

  bool rests = false;  ///< its body sleeps, in the coming substep

  // As of the substep `seen`:
  std::uint64_t seen = 0;                  ///< 0: none yet
  math::Vector3 centre{0, 0, 0};           ///< of mass, in the world [m]
  math::Vector3 velocity{0, 0, 0};         ///< of it [m/s]
  math::Vector3 turning{0, 0, 0};          ///< [rad/s]
  Need need{};                             ///< of all its pairs
  std::uint64_t seen_before = 0;           ///< the substep of these:
  math::Vector3 velocity_before{0, 0, 0};  ///< [m/s]
  math::Vector3 turning_before{0, 0, 0};   ///< [rad/s]

  /// All but what it is made of.
  void archive(math::Archive& archive);
};

/// A pair of fixed magnets of different carriers that are close enough to matter.
struct ClosePair {
  std::uint32_t first = 0, second = 0;  ///< magnets
  Need need{};
};

/// No two magnets farther apart than this are a ClosePair [m].
/// @param moment           the largest of a magnet [A m^2]
/// @param inverse_mass     the largest of a carrier, as felt at its magnets [1/kg]
/// @param inverse_inertia  the largest of a carrier [1/(kg m^2)]
double close_reach(double moment, double inverse_mass, double inverse_inertia, double substep);

/// Stiffness of a pair of magnets. The bounds hold for any directions of the moments.
struct PairOfMagnets {
  double moments = 0;            ///< product of both [(A m^2)^2]
  double distance = 0;           ///< as it counts [m]
  double closest = 0;            ///< that contact allows; 0: unknown [m]
  math::Vector3 first{0, 0, 0};  ///< where they are [m]
  math::Vector3 second{0, 0, 0};
};

/// Both were seen in this substep, or rest.
/// @param substep  its length [s];  @param now  its number
/// @return  none if they are too far apart to matter
std::optional<Need> need_of(const PairOfMagnets& pair, const Carrier& a, const Carrier& b,
                            double substep, std::uint64_t now);

/// Into how many parts the substep must be divided for a pair of two carriers; 0: it is taken as a
/// whole.
int parts_for(const Need& need, const Carrier& a, const Carrier& b);

}  // namespace ziggurat::physics
