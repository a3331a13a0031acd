// SPDX-License-Identifier: MIT
#pragma once
// Geometric stiffness: tension makes links stiff against rotation. Links of a chain swing with up
// to sqrt(4 T / (m l)) (tension, mass and length of a link). Impulses act along the lines of a
// step's beginning, so from 2 rad per step on this is unstable.

#include <span>
#include <vector>

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

/// Working memory of parts_for_geometric_stiffness().
struct GeometricStiffness {
  std::vector<int> first_link;              ///< of each tree
  std::vector<int> free;                    ///< free joint coordinates of each tree
  std::vector<Vector3> impulse;             ///< on each link and its subtree [N s]
  std::vector<Matrix3> dyad;                ///< of each link: sum of arms times impulses [N m s]
  std::vector<Motion> change;               ///< of speeds, of each link of a tree
  std::vector<double> direction, response;  ///< of each dof
};

/// Number of parts into which an island should divide its step so that such swinging is resolved;
/// its problem is solved.
///
/// A link with impulses P at arms r from its centre of mass has the rotational stiffness K: h K =
/// tr(D) - D, with D the symmetric part of the sum of r P^T. P are impulses of contacts, joints,
/// external forces and inertia. The link swings with the root of K (J M^-1 J^T) while all others
/// move freely, J the rows of its angular velocity. Compressed links do not swing, and servos and
/// limits hold their joints.
/// @param contacts  of the problem's constraints
/// @return          1: undivided
int parts_for_geometric_stiffness(const Problem& problem, std::span<const ContactPoint> contacts,
                                  Workspace& work, GeometricStiffness& memory);

/// Into how many parts the step of an island should be divided so that the axes of what is in
/// contact can be followed. A single body nutates by the speed of its spin, times the spread of its
/// moments of inertia over the middle one; what turns on a revolute joint by its angular momentum
/// in the joint, times the mobility of turning across it.
/// @return  1: it need not be
int parts_for_gyroscopic_stiffness(const Problem& problem, Workspace& work);

}  // namespace ziggurat::dynamics
