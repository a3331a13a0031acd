#pragma once
// Plug-ins that are a force law.

#include "physics/plugin.h"

namespace ziggurat::physics {

/// -m g at the centre of mass of every part that moves.
class Gravity final : public Plugin {
 public:
  explicit Gravity(double g) : g_(g) {}  ///< @param g  downward [m/s^2]
  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  double g_;
};

/// Viscous damping: force -m v (k + k |v|) and torque -I w (k + k |w|) on links that ask for it. It
/// is limited to what stops the link within the substep. It is the law of Bullet's multi-bodies,
/// for rigid bodies and for links damped unlike their neighbours.
class ViscousDamping final : public Plugin {
 public:
  void body_added(Body& body) override;
  void body_removed(const Body& body) override;
  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  std::vector<std::size_t> damped_;  ///< entities with a damped link
  std::vector<Twist> motions_;
};

}  // namespace ziggurat::physics
