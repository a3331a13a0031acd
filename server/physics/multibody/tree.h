// SPDX-License-Identifier: MIT
#pragma once
// An articulated tree of rigid bodies in generalised coordinates. A single body is a tree of one
// link. Links come parents first; link 0 is the root.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/multibody/spatial.h"

namespace ziggurat::dynamics {

/// Joint between a link and its parent.
enum class JointType : std::uint8_t {
  floating,   ///< the root of a tree that moves: up to six degrees of freedom in the world
  fixed,      ///< the root of a tree that stands on the world
  revolute,   ///< turns about an axis
  prismatic,  ///< slides along an axis
  spherical,  ///< turns about a point; its speeds are along the child's joint frame
};

/// One rigid body. Its frame is at its centre of mass, along its principal axes.
struct Link {
  int parent = -1;
  JointType joint = JointType::floating;
  math::Pose joint_in_parent;  ///< X_PJ
  math::Pose joint_in_link;    ///< X_LJ
  Vector3 axis{0, 0, 1};       ///< of revolute and prismatic joints, unit, in the joint's frame
  double mass = 0;             ///< [kg], > 0 unless fixed
  Vector3 inertia{0, 0, 0};    ///< principal [kg m^2], > 0 unless fixed
  double damping = 0;          ///< of the joint's speeds [N m s] or [N s/m]

  bool operator==(const Link& other) const;
};

/// Inertia of a link about a point.
/// @param rotation  of the link;  @param arm  of its centre of mass from the point [m]
Inertia inertia_about(const Link& link, const Matrix3& rotation, const Vector3& arm);

/// Freedoms of a floating root: bits of rotation about x, y, z and translation along x, y, z of the
/// world.
constexpr unsigned all_freedoms = 0b111111;
constexpr unsigned upright_freedoms = 0b111100;  ///< turns about z only
constexpr unsigned planar_freedoms = 0b011100;   ///< as well, and keeps its height

/// Rotation of a revolute joint's link in its parent's frame: R(q) = constant + cos q cosine + sin
/// q sine, by Rodrigues' formula between the constant rotations of the joint's frames.
struct RevoluteRotation {
  Matrix3 constant = Matrix3::Zero(), cosine = Matrix3::Zero(), sine = Matrix3::Zero();
  Vector3 axis{0, 0, 0};  ///< in the parent's frame
};

/// A floating base with all freedoms that carries nothing but symmetric rotors: a gyrostat. In the
/// base's frame neither its inertia nor the rotors' axes depend on the joints' angles.
struct Gyrostat {
  Inertia inertia;  ///< of all links, about the base's centre of mass, along the base's axes
  std::vector<double> axial_inertia;  ///< of the rotor of each dof; 0: of the base [kg m^2]
};

/// Constant data of a tree.
struct TreeModel {
  TreeModel(std::vector<Link> links, unsigned freedoms);

  std::vector<Link> links;
  unsigned freedoms;                ///< of a floating root
  int position_count = 0;           ///< size of q
  int dofs = 0;                     ///< size of v
  std::vector<int> first_dof;       ///< of each link, into v
  std::vector<int> dof_count;       ///< of each link
  std::vector<int> first_position;  ///< of each link, into q
  std::vector<int> parent_dof;     ///< of each dof: the one before it on the way to the root, or -1
  std::vector<double> damping;     ///< of each dof [N m s] or [N s/m]
  std::vector<int> ancestor_dofs;  ///< the dofs from the root to each link, one after the other
  std::vector<int> ancestor_dofs_end;  ///< of each link, into `ways`
  std::vector<int> dof_numbers;        ///< 0, 1, … dofs - 1
  /// Symmetric rotors, for each dof: its joint turns a link without children that is symmetric
  /// about the axis. Then the mass matrix does not depend on the angle, and other motion leaves the
  /// link's axial angular momentum unchanged.
  std::vector<unsigned char> is_symmetric_rotor;
  std::vector<Matrix3> joint_in_parent_rotation,
      link_in_joint_rotation;              ///< rotations X_PJ and X_JL of each link
  std::vector<RevoluteRotation> revolute;  ///< of each link; other joints' is not used
  bool has_floating_base =
      false;  ///< floating with all six freedoms: dofs 0 to 5 are the world's axes
  bool is_single_body = false;       ///< one link, with a free root
  std::optional<Gyrostat> gyrostat;  ///< of a tree that is one

 private:
  void find_gyrostat();
  void list_ancestor_dofs();
  void find_symmetric_rotors();
};

class Tree {
 public:
  /// @param root      pose of link 0 in the world
  /// @param freedoms  of a floating root
  Tree(std::vector<Link> links, const math::Pose& root, unsigned freedoms = all_freedoms);
  /// Builds a tree that shares another's model.
  Tree(const Tree& like, const math::Pose& root);

  // Constants: views of the TreeModel.
  std::span<const Link> links;
  unsigned freedoms = 0;
  int dofs = 0;
  std::span<const int> first_dof, dof_count, first_position, parent_dof;
  std::span<const double> damping;
  std::span<const unsigned char> is_symmetric_rotor;
  std::span<const Matrix3> joint_in_parent_rotation, link_in_joint_rotation;
  std::span<const RevoluteRotation> revolute;
  bool has_floating_base = false, is_single_body = false;
  const Gyrostat* gyrostat = nullptr;  ///< null: it is none

  // The state.
  /// A floating root: position [m] and orientation w x y z; a revolute joint: angle [rad]; a
  /// prismatic one: length [m]; a spherical one: orientation w x y z.
  std::vector<double> q;
  /// A floating root: angular velocity and velocity of its centre of mass, both along the world's
  /// axes, as far as it has the freedoms; joints: their speeds. [rad/s], [m/s]
  std::vector<double> v;

  // Forces of the coming substep.
  Vector3 gravity{0, 0, 0};  ///< acceleration of all links, world axes [m/s^2]
  /// External wrench on each link at its centre of mass, world axes [N m], [N]. It acts as one
  /// impulse at the beginning, so that the substep is symplectic. A Taylor step would pump energy
  /// into stiff fields.
  std::vector<Wrench> external;
  /// External wrenches when the tree fell asleep.
  std::vector<Wrench> external_at_sleep;

  // Results of forward_kinematics(), from q.
  std::vector<Matrix3> rotation;        ///< of each link in the world
  std::vector<Vector3> position;        ///< of each link's centre of mass in the world [m]
  std::vector<Motion> motion_subspace;  ///< of each dof: motion vector of its unit speed, about O
  Vector3 origin{0, 0, 0};              ///< O: the root's centre of mass [m]

  // Results of velocity_kinematics(), from q and v.
  std::vector<Motion> spatial_velocity;  ///< of each link, about O

  double integrator_step = 0;  ///< the integrator's next step [s]

  /// Archives the state: all that the next substep reads.
  void archive(math::Archive& archive);

  /// Shares another tree's model if it is equal, so that memory and caches hold it once.
  /// @return  whether it is
  bool share_model(const Tree& other);

  /// Becomes one link that is fixed to the world, without dofs. Takes no memory.
  void clear() noexcept;

  std::span<const int> dofs_of(int link) const;  ///< that move a link, ascending
  std::span<const int> dof_span(int dof) const;  ///< a span of it
  math::Pose pose(int link) const;               ///< X_WL, after forward_kinematics()
  bool has_rotations() const;                    ///< all quaternions in q have length 1
  void set_root(const math::Pose& pose);         ///< of a floating or fixed root
  Vector3 velocity(int link) const;  ///< of the centre of mass, after velocity_kinematics() [m/s]
  Vector3 angular_velocity(int link) const;  ///< after velocity_kinematics() [rad/s]

 private:
  void use_model(std::shared_ptr<const TreeModel> mechanism) noexcept;
  void reset_state();
  std::shared_ptr<const TreeModel> model_;
  math::Pose fixed_root_;
  friend void forward_kinematics(Tree& tree);
};

/// Prefetches a tree's state and kinematics: see prefetch.h.
void prefetch(const Tree& tree);

/// Forward kinematics: poses, motion subspaces and origin from q.
void forward_kinematics(Tree& tree);
/// Velocity kinematics: spatial velocities of links from v; needs forward_kinematics().
void velocity_kinematics(Tree& tree);

/// Integrates positions: q moves by a displacement in the coordinates of v, rotations by the
/// exponential map.
/// @param step  [rad], [m]
void integrate_positions(Tree& tree, std::span<const double> step);

inline std::span<const int> Tree::dofs_of(int link) const {
  const TreeModel& m = *model_;
  const int begin = link > 0 ? m.ancestor_dofs_end[link - 1] : 0;
  return {m.ancestor_dofs.data() + begin,
          static_cast<std::size_t>(m.ancestor_dofs_end[link] - begin)};
}
inline std::span<const int> Tree::dof_span(int dof) const {
  return {model_->dof_numbers.data() + dof, 1};
}

/// The dof of a revolute or prismatic joint.
inline int joint_dof(const Tree& tree, int link) { return tree.first_dof[link]; }

/// Kinetic energy [J]; needs velocity_kinematics().
double kinetic_energy(const Tree& tree);

}  // namespace ziggurat::dynamics
