#pragma once
// Plug-ins that are a force law.

#include "physics/plugin.h"

namespace ziggurat::physics {

/// Viscous damping: force -m v (k + k |v|) and torque -I w (k + k |w|) on links that ask for it. It
/// is limited to what stops the link within the substep.
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
