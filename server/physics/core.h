#pragma once
// The mechanical core: joints, motors, contacts, and the equations of motion. World adds bodies to
// it, plug-ins push them, and it moves them on by a substep. There are two: on dynamics/ (newton/),
// and on Bullet's multi-bodies (bullet/); the scene chooses one.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "physics/bodies.h"
#include "physics/overlap.h"
#include "physics/plugin.h"
#include "scene/scene.h"

namespace ziggurat::physics {

class NewtonCore;
class SweepsCore;

class Core {
 public:
  explicit Core(const scene::Physics& physics);
  ~Core();  ///< Its bodies must be gone before: see take_apart().

  /// Adds the half-space z <= 0.
  void add_floor(const scene::Surface& surface);

  /// Builds an entity where it stands and puts it in.
  /// @param number  its place in the order of adding
  /// @throws std::bad_alloc; then nothing changes
  Body add(const scene::Entity& entity, std::size_t number);
  /// Takes a body out; what rested on it falls. Its joints stay, without a coordinate.
  void remove(Body& body);
  /// Takes all bodies out before the end, in linear time; nothing may be asked of them afterwards.
  void take_apart(std::span<Body> bodies);
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
  void set_target(JointIndex joint, double target);
  /// Puts a joint there, moving so; its body remembers no contact. @pre it is Newton's core
  void set_joint(JointIndex joint, double position, double velocity);
  double position(JointIndex joint) const;  ///< [m] or [rad]
  double velocity(JointIndex joint) const;  ///< [m/s] or [rad/s]

  /// Moves all bodies on, with the forces that were applied since the last substep.
  /// @param length  [s]
  /// @param splits  a motor may give its impulse in so many substeps
  /// @param stiff   what has stiff pairs; null: none. Bullet's core takes no notice of them.
  void substep(std::span<Body> bodies, double length, int splits, Plugin* stiff);

  /// Lists contacts of the last substep, in ascending order.
  void contacts(std::vector<LinkContact>& out) const;

  Convergence convergence() const;

  /// The state. @pre it is not Bullet's core, which keeps some to itself
  void archive(math::Archive& archive);

 private:
  std::variant<std::unique_ptr<SweepsCore>, std::unique_ptr<NewtonCore>> core_;
};

}  // namespace ziggurat::physics
