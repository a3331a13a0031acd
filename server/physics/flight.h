// SPDX-License-Identifier: MIT
#pragma once
// Flight: the force and torque by which a flying body holds itself up, upright, and goes where it
// is to be.

#include "physics/plugin.h"

namespace ziggurat::physics {

/// Cascaded control as in autopilots (PX4 User Guide, "Controller Diagrams"). An outer loop makes
/// an error of position a velocity, an inner one makes an error of velocity a force:
///
///     v* = limit(k_p (p* - p), max_speed)
///     a  = limit((v* - v) (1 - exp(-k_v h)) / h, max_acceleration)
///     F  = m (a + g z)
///
/// with the substep h, so that v - v* falls by exp(-k_v h) in each substep, however long it is.
/// |F| is m (g + max_acceleration) at most, in any direction: that a rotorcraft tilts to push
/// aside is left out. Likewise for the rotation vector to the upright pose at the heading:
///
///     w*  = limit(k_p r, max_turn_rate)
///     tau = I limit((w* - w) (1 - exp(-k_v h)) / h, max_turn_acceleration) + w x I w
///
/// k_v = 4 k_p: critically damped. The part m g is no force here: the body's tree has no gravity
/// (build_tree.cpp), so that the two cancel to the last bit.
class Flight final : public Plugin {
 public:
  void body_added(Body& body) override;
  void body_removed(const Body& body) override;
  void body_moved(Body& body) override;
  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  std::vector<std::size_t> entities_;  // that fly and move
  std::vector<Twist> motions_;
};

/// Hovering at a pose of the entity's origin.
FlightTarget hover_at(const math::Pose& pose);

}  // namespace ziggurat::physics
