#pragma once
// The core on dynamics/: a tree per entity, contacts by Newton's method. Its functions are those of
// physics/core.h.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/system.h"
#include "physics/bodies.h"
#include "physics/newton/contacts.h"
#include "physics/newton/motors.h"
#include "physics/overlap.h"
#include "physics/plugin.h"
#include "scene/scene.h"

namespace ziggurat::physics {

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
  std::optional<std::size_t> overlapped_by(std::span<const PlacedCollider> colliders) const;

  JointIndex joint(std::size_t entity, std::size_t joint) const;
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  void set_target(JointIndex joint, double target) { joints_[joint.value].target = target; }
  double position(JointIndex joint) const;
  double velocity(JointIndex joint) const;

  void substep(std::span<Body> bodies, double length, int splits);
  void contacts(std::vector<Contact>& out) const { contacts_.tell(out); }
  Convergence convergence() const { return convergence_; }

 private:
  /// A body that is held to a motion over the ground.
  struct Held {
    std::size_t entity = 0;
    std::array<double, 3> impulses{};  // of the last substep [N s], [N m s]
  };

  void detach(std::size_t entity);
  void set_servos_and_limits(std::span<Body> bodies, double length, int splits);
  void remember();

  scene::Physics settings_;
  dynamics::System system_;
  Colliders colliders_;
  Contacts contacts_{colliders_};
  std::vector<CoordinateJoint> joints_;
  std::vector<Held> held_;
  std::vector<dynamics::Servo> servos_;
  std::vector<dynamics::Limit> limits_;
  Convergence convergence_;
};

}  // namespace ziggurat::physics
