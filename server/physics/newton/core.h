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

/// What acts on a set of trees that takes a substep in parts, in its order.
struct HeldBack {
  std::vector<dynamics::Wrench> pushes;  ///< on their links
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

  void substep(std::span<Body> bodies, double length, int splits, Plugin* stiff);
  void contacts(std::vector<Contact>& out) const { contacts_.tell(out); }
  Convergence convergence() const { return convergence_; }
  friend void archive_fields(math::Archive& archive, NewtonCore& core);

 private:
  /// A body that is held to a motion over the ground.
  struct Held {
    std::size_t entity = 0;
    std::array<double, 3> impulses{};  // of the last substep [N s], [N m s]
  };

  void detach(std::size_t entity);
  /// Trees that take a part of a substep, or all of it.
  struct Share {
    const TreeSet* chosen = nullptr;  // null: all
    double length = 0;                // [s]
    int splits = 1;                   // of the scene's substep, see substep()
    double of_impulses = 1;           // of the substep's forces and impulses, that act in it
    bool more = false;                // other parts follow
    int parts_left = 1;               // until motors should be at their targets, with this one
    int most_parts = 1;               // into which islands may divide it
    bool is_part = false;             // it is one of these
    double allowed_overlap = 1e-6;    // that remains [m]
    double softness = dynamics::System::default_compliance_factor;
    std::span<const int> trees() const { return chosen ? chosen->trees : std::span<const int>(); }
  };
  void prepare(std::span<Body> bodies, const Share& share);
  bool wake_disturbed(const Share& share, std::span<dynamics::ContactPoint>& contacts, bool woke);
  void step(const Share& share);
  bool foresee(const Share& share, std::span<dynamics::ContactPoint>& contacts, bool& woke);
  void take_part(std::span<Body> bodies, const Share& part);
  void remember(const Share& share);
  void substep_in_parts(std::span<Body> bodies, double length, int splits, int count,
                        Plugin& stiff);
  void divide(std::span<Body> bodies, const Share& whole);
  void take_parts(std::span<Body> bodies, const Share& whole, int count);

  scene::Physics settings_;
  dynamics::System system_;
  dynamics::Workspace work_;
  Colliders colliders_;
  Contacts contacts_{colliders_};
  std::vector<CoordinateJoint> joints_;
  std::vector<Held> held_;
  std::vector<dynamics::Servo> servos_;
  std::vector<dynamics::Limit> limits_;
  Division division_;
  Lags lags_;
  dynamics::IslandsToSubdivide left_;  // by the whole substep
  TreeSet chosen_;              // the trees of one of them, or all others
  HeldBack held_back_;
  dynamics::PredictedVelocities foresight_;
  Convergence convergence_;
};

}  // namespace ziggurat::physics
