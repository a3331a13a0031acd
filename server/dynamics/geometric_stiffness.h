#pragma once
// Tension that is too much for a substep. A link that is pulled at both ends is stiff against turning: where a contact or a
// servo pulls a chain of light links, they swing with up to sqrt(4 T / (m l)) (tension, mass and length of a link). Impulses are
// those of the places at a step's beginning, so from 2 rad per step on such swinging would grow without end.

#include <span>
#include <vector>

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Memory of parts_for_geometric_stiffness(), which it uses again.
struct GeometricStiffness {
  std::vector<int> first_link;              ///< of each tree
  std::vector<int> free;                    ///< coordinates of each tree's joints that nothing holds
  std::vector<Vector3> impulse;             ///< on each link and on what it carries [N s]
  std::vector<Matrix3> dyad;                ///< of each link: sum of arms times impulses [N m s]
  std::vector<Motion> change;               ///< of speeds, of each link of a tree
  std::vector<double> direction, response;  ///< of each dof
};

/// Into how many parts the step of an island should be divided so that its links can be followed; its problem is solved.
///
/// A link on which impulses P act at arms r from its centre of mass resists turning by an angle with the stiffness K:
/// h K = tr(D) - D, D the symmetric part of the sum of r P^T, the second derivative of -P x by the angle. P are those of contacts, of joints,
/// of forces from outside, and of inertia against the change of speed. So a link swings with the root of K (J M^-1 J^T) while all others
/// move freely, J the rows of its angular velocity. What is pressed does not swing, and what servos or limits hold does
/// not give way.
/// @param contacts  of the problem's blocks
/// @return          1: it need not be
int parts_for_geometric_stiffness(const Problem& problem, std::span<const ContactPoint> contacts, Workspace& work, GeometricStiffness& memory);

}  // namespace ziggurat::dynamics
