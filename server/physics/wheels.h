// SPDX-License-Identifier: MIT
#pragma once
// Driven wheels and turrets: what a robot on wheels is to do over the ground, and how its turret
// turns on it. Bodies that a plane holds are wheels that stand still.

#include "physics/plugin.h"

namespace ziggurat::physics {

class Wheels final : public Plugin {
 public:
  void body_added(Body& body) override;
  void body_removed(const Body& body) override;
  void body_moved(Body& body) override;

  /// Aims at the velocity that carries the body along its arc for a substep: the chord's, at the
  /// heading half way. So a circle closes however long substeps are.
  void before_substep(std::span<Body> bodies, double substep) override;
  /// Turns turrets as far as they turned while the body moved.
  void after_substep(std::span<Body> bodies, double substep) override;

 private:
  std::vector<std::size_t> entities_;  // with a GroundMotion
  std::vector<Twist> motions_;
};

}  // namespace ziggurat::physics
