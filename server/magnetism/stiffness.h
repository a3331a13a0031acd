// SPDX-License-Identifier: MIT
#pragma once
// Is a magnetic bond too stiff for the substep? Two bodies held face to face by their magnets swing
// sideways and twist against each other; explicit substeps follow that only up to w dt = 2.

#include <array>
#include <span>

#include "magnetism/field.h"

namespace ziggurat::magnetism {

/// A body that may be bonded to another of its kind, face to face.
struct BondedBody {
  Vector3 half_extents = Vector3::Zero();  ///< of the collision box around the body's origin [m]
  Vector3 offset = Vector3::Zero();        ///< of the box's centre from the body's origin [m]
  double mass;                             ///< > 0 [kg]
  Vector3 inertia = Vector3::Zero();       ///< principal, along the body's axes, > 0 [kg m^2]
};

struct Bond {
  double stiffness = 0;     ///< sideways, of all magnets of the face [N/m]
  double twist = 0;         ///< about the face's normal [N m/rad]
  double lateral_rate = 0;  ///< sqrt(K / reduced mass) [rad/s]
  double twist_rate = 0;    ///< sqrt(K r^2 / reduced inertia) [rad/s]
};

/// Bonds of freely turning magnets come to rest while substep * rate is below this (the limit of
/// explicit substeps is 2). Bodies with fixed magnets that tumble freely need far less: they fall
/// together within a substep.
inline constexpr double stiffest_product = 1.6;

/// The bond of two such bodies whose faces along +-x, +-y, +-z (in this order) touch, every magnet
/// facing its mirror image. A freely turning magnet at depth t below the face contributes
/// K = 6 (mu0/4pi) m^2 / (2 t)^5, a magnet fixed in the body twice that.
/// @param magnets   of any bodies; those of `body` count, with the current given for all
std::array<Bond, 6> bonds(std::span<const Magnet> magnets, std::uint32_t body,
                          const BondedBody& bonded, double current = 0);

/// The largest rate of all six faces [rad/s]; the substep is short enough where
/// substep * rate < stiffest_product.
double stiffest_rate(std::span<const Magnet> magnets, std::uint32_t body, const BondedBody& bonded,
                     double current = 0);

}  // namespace ziggurat::magnetism
