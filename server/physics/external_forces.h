#pragma once
// Forces and torques that something outside of the world puts on links.

#include <cstddef>
#include <vector>

#include "math/pose.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

class ExternalForces final : public Plugin {
 public:
  struct Force {
    std::size_t entity = 0;                        ///< in order of adding
    std::size_t link = 0;                          ///< into Body::links
    math::Vector3 force = math::Vector3::Zero();   ///< at the link's centre of mass, in W [N]
    math::Vector3 torque = math::Vector3::Zero();  ///< in W [N m]
  };

  /// Sets the forces of the substeps from the next one on.
  void set(std::vector<Force> pushes) { forces_ = std::move(pushes); }

  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  std::vector<Force> forces_;
};

}  // namespace ziggurat::physics
