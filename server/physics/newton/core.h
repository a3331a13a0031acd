#pragma once
// The core on dynamics/: a tree per entity, contacts by Newton's method. Its functions are those of
// physics/core.h.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/system.h"
#include "physics/bodies.h"
#include "physics/newton/contact_cache.h"
#include "physics/newton/substep_partition.h"
#include "physics/newton/leapfrog_sync.h"
#include "physics/newton/motors.h"
#include "physics/overlap.h"
#include "physics/plugin.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// Forces on a set of trees that takes a substep in parts, in its order.
struct DeferredForces {
  std::vector<dynamics::Wrench> wrenches;  ///< on their links
  std::vector<math::Vector3> gravity;    ///< that was taken from them: of the first ones, or of all [m/s^2]
};

class NewtonCore {
 public:
  explicit NewtonCore(const scene::Physics& physics);
  NewtonCore(const NewtonCore&) = delete;
  NewtonCore& operator=(const NewtonCore&) = delete;

  void add_floor(const scene::Surface& surface) { colliders_.add_floor(surface); }
  Body add(const scene::Entity& entity, std::size_t number);
  void remove(Body& body);
  void take_back(Body& body);
  void move(Body& body);
  std::optional<std::size_t> overlapped_by(std::span<const PlacedCollider> colliders,
                                           std::size_t except) const;

  JointIndex joint(std::size_t entity, std::size_t joint) const;
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  void set_target(JointIndex joint, double target) { joints_[joint.value].target = target; }
  double position(JointIndex joint) const;
  double velocity(JointIndex joint) const;

  void substep(std::span<Body> bodies, double time_step, int splits, Plugin* stiff);
  void contacts(std::vector<LinkContact>& out) const { contacts_.list_contacts(out); }
  Convergence convergence() const { return convergence_; }
  friend void set_joint(NewtonCore& core, JointIndex joint, double position, double velocity);
  /// Forgets of an entity that was put somewhere else what it remembers of contacts, joints and steps.
  friend void begin_anew(NewtonCore& core, std::size_t entity);
  friend void archive_fields(math::Archive& archive, NewtonCore& core);

 private:
  /// A body whose servos hold it to a motion over the ground.
  struct GroundServo {
    std::size_t entity = 0;
    std::array<double, 3> impulses{};  // of the last substep [N s], [N m s]
  };

  void detach(std::size_t entity);
  /// Trees that take a part of a substep, or all of it.
  struct SubstepPart {
    const TreeSet* active = nullptr;  // null: all
    double time_step = 0;                // [s]
    int splits = 1;                   // of the scene's substep, see substep()
    double force_share = 1;           // of the substep's forces and impulses, that act in it
    bool is_followed = false;                // other parts follow
    int parts_left = 1;               // until motors should reach their targets, with this one
    int most_parts = 1;               // into which islands may divide it
    bool is_part = false;             // it is one of these
    double allowed_overlap = 1e-6;    // that remains [m]
    double compliance_factor = dynamics::System::default_compliance_factor;
    std::span<const int> trees() const { return active ? active->trees : std::span<const int>(); }
  };
  void prepare(std::span<Body> bodies, const SubstepPart& part);
  bool wake_disturbed(const SubstepPart& part, std::span<dynamics::ContactPoint>& contacts, bool woke);
  void step(const SubstepPart& part);
  bool predict_contacts(const SubstepPart& part, std::span<dynamics::ContactPoint>& contacts, bool& woke);
  void step_part(std::span<Body> bodies, const SubstepPart& part);
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
  std::vector<dynamics::Servo> servos_;
  std::vector<dynamics::Limit> limits_;
  SubstepPartition partition_;
  LeapfrogSync leapfrog_sync_;
  dynamics::IslandsToSubdivide islands_to_subdivide_;  // by the whole substep
  TreeSet active_;              // the trees of one of them, or all others
  DeferredForces deferred_forces_;
  dynamics::PredictedVelocities prediction_;
  Convergence convergence_;
};

/// Puts a joint to a position [m] or [rad] and a speed [m/s] or [rad/s].
void set_joint(NewtonCore& core, JointIndex joint, double position, double velocity);

}  // namespace ziggurat::physics
