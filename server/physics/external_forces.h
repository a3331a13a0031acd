#pragma once
// Forces and torques that something outside of the world puts on links.

#include <cstddef>
#include <vector>

#include "math/pose.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

class Pushes final : public Plugin {
 public:
  struct Push {
    std::size_t entity = 0;                        ///< in order of adding
    std::size_t link = 0;                          ///< into Body::links
    math::Vector3 force = math::Vector3::Zero();   ///< at the link's centre of mass, in W [N]
    math::Vector3 torque = math::Vector3::Zero();  ///< in W [N m]
  };

  /// Those of the substeps from the next one on.
  void set(std::vector<Push> pushes) { pushes_ = std::move(pushes); }

  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  std::vector<Push> pushes_;
};

}  // namespace ziggurat::physics
