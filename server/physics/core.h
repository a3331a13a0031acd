// SPDX-License-Identifier: MIT
#pragma once
// The mechanical core: joints, motors, contacts, and the equations of motion, on stepping/, with a
// tree per entity. World adds bodies to it, plug-ins push them, and it moves them on by a substep.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies/bodies.h"
#include "physics/collision/contact_cache.h"
#include "physics/collision/overlap.h"
#include "physics/grips.h"
#include "physics/motors.h"
#include "physics/plugin.h"
#include "physics/stepping/system.h"
#include "physics/substep_partition.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Forces on a set of trees that takes a substep in parts, in its order.
struct DeferredForces {
  std::vector<dynamics::Wrench> wrenches;  ///< on their links
  std::vector<math::Vector3>
      gravity;  ///< that was taken from them: of the first ones, or of all [m/s^2]
};

class NewtonCore {
 public:
  explicit NewtonCore(const scene::Physics& physics);
  NewtonCore(const NewtonCore&) = delete;
  NewtonCore& operator=(const NewtonCore&) = delete;

  /// Adds the half-space z <= 0.
  void add_floor(const scene::Surface& surface) { colliders_.add_floor(surface); }
  /// Builds an entity where it stands and puts it in.
  /// @param number  its place in the order of adding
  /// @throws std::bad_alloc; then nothing changes
  Body add(const scene::Entity& entity, std::size_t number);
  /// Takes a body out; what rested on it falls. Its joints stay, without a coordinate.
  void remove(Body& body);
  /// Undoes the last add().
  void take_back(Body& body);
  /// Puts a body to rest where `placed` says, joints as assembled; it remembers no contact.
  void move(Body& body);
  /// The first entity, in order of adding, that one of the colliders overlaps. The floor doesn't
  /// count, nor does `except`; touching is not overlapping.
  std::optional<std::size_t> overlapped_by(std::span<const PlacedCollider> colliders,
                                           std::size_t except) const;

  JointIndex joint(std::size_t entity, std::size_t joint) const;
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  void set_target(JointIndex joint, double target) { joints_[joint.value].target = target; }
  double position(JointIndex joint) const;  ///< [m] or [rad]
  double velocity(JointIndex joint) const;  ///< [m/s] or [rad/s]

  /// Lets a gripper hold what it touches. Without effect while the robot has a grip, torn or not.
  void grip(std::span<const Body> bodies, std::size_t entity, const Gripper& gripper);
  void release(std::size_t entity);               ///< ends the grip of a robot, if there is one
  const Grip* grip_of(std::size_t entity) const;  ///< null: none
  /// Tears grips, and turns turrets with them: to be called after a substep.
  void end_grips(std::span<Body> bodies);

  /// Moves all bodies on, with the forces that were applied since the last substep.
  /// @param time_step  [s]
  /// @param splits     a motor may give its impulse in so many substeps
  /// @param stiff      the plug-in that has stiff pairs; null: none
  /// @param watch      gets the times of its stages; null: none
  void substep(std::span<Body> bodies, double time_step, int splits, Plugin* stiff,
               timing::Stopwatch* watch = nullptr);
  /// Lists contacts of the last substep, in ascending order.
  void contacts(std::vector<LinkContact>& out) const { contacts_.list_contacts(out); }
  Convergence convergence() const { return convergence_; }
  /// Substeps are shared by so many threads, with the same bits for any number.
  /// @throws std::system_error if the system allows no more threads; then nothing changes
  void set_threads(unsigned threads);
  dynamics::Team* team() const { return system_.team(); }  ///< null: one thread
  /// See dynamics::System.
  std::uint64_t sleep_changes() const { return system_.sleep_changes(); }
  friend void set_joint(NewtonCore& core, JointIndex joint, double position, double velocity);
  /// Forgets of an entity that was put somewhere else what it remembers of contacts, joints and
  /// steps.
  friend void begin_anew(NewtonCore& core, std::size_t entity);
  friend void archive_fields(math::Archive& archive, NewtonCore& core);

 private:
  /// A body whose servos hold it to a motion over the ground.
  struct GroundServo {
    std::size_t entity = 0;
    std::array<double, 3> impulses{};  // of the last substep [N s], [N m s]
  };

  void detach(std::size_t entity);
  void end_grips_with(std::size_t entity);
  /// Trees that take a part of a substep, or all of it.
  struct SubstepPart {
    const TreeSet* active = nullptr;  // null: all
    double time_step = 0;             // [s]
    int splits = 1;                   // of the scene's substep, see substep()
    double force_share = 1;           // of the substep's forces and impulses, that act in it
    bool is_followed = false;         // other parts follow
    double time_to_target = 0;  // until motors should reach their targets, from its beginning [s]
    bool is_part = false;       // it is one of the parts of a divided island
    dynamics::StepOptions options{.impact_mode = dynamics::ImpactMode::end_step};
    std::span<const int> trees() const { return active ? active->trees : std::span<const int>(); }
  };
  void prepare(std::span<Body> bodies, const SubstepPart& part);
  bool wake_disturbed(const SubstepPart& part, std::span<dynamics::ContactPoint>& contacts,
                      bool woke);
  void step(const SubstepPart& part);
  bool predict_contacts(const SubstepPart& part, std::span<dynamics::ContactPoint>& contacts,
                        bool& woke);
  void step_active(std::span<Body> bodies, const SubstepPart& part);
  void step_part(std::span<Body> bodies, const SubstepPart& part);
  void step_to_impacts(std::span<Body> bodies, const SubstepPart& whole, std::span<const int> trees,
                       double first_impact);
  void apply_impacts(std::span<Body> bodies, const SubstepPart& part);
  void store_impulses(const SubstepPart& part);
  void step_leapfrog(std::span<Body> bodies, double time_step, int splits, int count,
                     Plugin& stiff);
  void step_divided_islands(std::span<Body> bodies, const SubstepPart& whole);
  void step_in_parts(std::span<Body> bodies, const SubstepPart& whole, int count);

  scene::Physics settings_;
  dynamics::System system_;
  dynamics::Workspace work_;
  Colliders colliders_;
  ContactCache contacts_{colliders_};
  std::vector<CoordinateJoint> joints_;
  std::vector<GroundServo> ground_servos_;
  std::vector<Grip> grips_;  // ascending by the entity that grips
  std::vector<dynamics::Servo> servos_;
  std::vector<dynamics::Limit> limits_;
  SubstepPartition partition_;
  LeapfrogSync leapfrog_sync_;
  dynamics::IslandsToSubdivide islands_to_subdivide_;  // by the whole substep
  dynamics::IslandsToSubdivide islands_with_impacts_;  // by a part of it
  TreeSet active_;                                     // the trees of one of them, or all others
  TreeSet in_impacts_;                                 // trees between two impacts
  TreeSet stepped_;                                    // trees that a step did not leave unchanged
  DeferredForces deferred_forces_;
  dynamics::PredictedVelocities prediction_;
  Convergence convergence_;
  timing::Stopwatch* watch_ = nullptr;  // of the present substep
};

/// Puts a joint to a position [m] or [rad] and a speed [m/s] or [rad/s]; its body remembers no
/// contact.
void set_joint(NewtonCore& core, JointIndex joint, double position, double velocity);

}  // namespace ziggurat::physics
