#pragma once
// Who touches whom, for those who watch a world. No robot is told.

#include <cstddef>
#include <optional>

#include "math/pose.h"

namespace ziggurat::world {

/// Two links, or a link and the floor, that touch.
struct Contact {
  std::size_t link = 0;                          ///< into State::links
  std::optional<std::size_t> other;              ///< likewise; none: the floor
  math::Vector3 point = math::Vector3::Zero();   ///< the middle of the contact points, in W [m]
  math::Vector3 normal = math::Vector3::Zero();  ///< unit, from the other one to `link`, in W
  math::Vector3 force = math::Vector3::Zero();   ///< on `link`, normal and friction, in W [N]
};

}  // namespace ziggurat::world
