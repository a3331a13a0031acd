#pragma once
// The core that sweeps: Bullet's bodies and multi-bodies, its rows of joints and contacts, and our
// sweeps over them. Its functions are those of physics/core.h.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies.h"
#include "physics/overlap.h"
#include "physics/plugin.h"
#include "scene/scene.h"

namespace ziggurat::physics {

class SweepsCore {
 public:
  explicit SweepsCore(const scene::Physics& physics);
  ~SweepsCore();  ///< Bodies in it must be removed before.

  void add_floor(const scene::Surface& surface);
  Body add(const scene::Entity& entity, std::size_t number);
  void remove(Body& body);
  void take_back(Body& body);
  void move(Body& body);
  std::optional<std::size_t> overlapped_by(std::span<const PlacedCollider> colliders,
                                           std::size_t except) const;

  JointIndex joint(std::size_t entity, std::size_t joint) const;
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  void set_target(JointIndex joint, double target);
  double position(JointIndex joint) const;
  double velocity(JointIndex joint) const;

  void substep(std::span<Body> bodies, double length, int splits);
  void contacts(std::vector<LinkContact>& out) const;
  Convergence convergence() const { return {}; }

 private:
  struct Ground;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ziggurat::physics
