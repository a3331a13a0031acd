// SPDX-License-Identifier: MIT
#pragma once
// Contact of two links, as plug-ins and devices see it.

#include <compare>
#include <cstddef>
#include <vector>

#include "math/pose.h"

namespace ziggurat::physics {

/// One of the two that touch.
struct ContactSide {
  static constexpr std::size_t floor = static_cast<std::size_t>(-1);
  std::size_t entity = floor;  ///< in order of adding
  std::size_t link = 0;        ///< into Body::links
  auto operator<=>(const ContactSide&) const = default;
};

/// Two links, or a link and the floor, in a substep in which they touch: they press each other, or
/// their surfaces meet.
struct LinkContact {
  ContactSide a, b;                               ///< a < b, so the floor is always b
  math::Vector3 normal = math::Vector3::Zero();   ///< unit, from b to a, in W
  math::Vector3 point = math::Vector3::Zero();    ///< the middle of the contact points, in W [m]
  math::Vector3 impulse = math::Vector3::Zero();  ///< on a, normal and friction, in W [N s]; where
                                                  ///< both sleep: of the last substep before
};

/// The same contact with its sides in ascending order.
LinkContact in_order(LinkContact contact);
/// Sorts contacts by their sides.
void sort(std::vector<LinkContact>& contacts);

}  // namespace ziggurat::physics
