// A contact is linear in the displacement. What turns far in a substep, as when it strikes a floor
// with a corner, may overlap by a part of its size at the end, with corners that were far away.

#include <algorithm>

#include "physics/convert.h"
#include "physics/newton/contacts.h"

namespace ziggurat::physics {
namespace {

constexpr btScalar close = btScalar(1e-3);  // points that must not come to overlap, either [m]
constexpr double deep = 2e-5;               // [m]

bool is_deep(const contact::Contacts& found) {
  return std::any_of(found.points.begin(), found.points.begin() + found.count,
                     [](const contact::Point& point) { return point.distance < -deep; });
}

}  // namespace

std::span<dynamics::Contact> Contacts::find_turned(const dynamics::System& system) {
  overlaps_.clear();
  for (const Turned& turned : turned_) {
    const Pair& pair = pairs_[turned.pair];
    if (pair.count == 0 && !turned.flies) continue;  // hidden
    const Collider& a = colliders_.all[pair.a];
    const Collider& b = colliders_.all[pair.b];
    const auto pose = [&](const Collider& collider) {
      return collider.moves ? colliders_.pose(collider, system) : collider.pose;
    };
    const contact::Contacts found =
        contact::find(a.shape, pose(a), b.shape, pose(b), close, contact::Support::all);
    if (!is_deep(found)) continue;
    const dynamics::Contact law = law_of(a, b, turned.flies ? from_bullet(found.normal) : pair.normal, std::max(pair.count, 1));
    for (int i = 0; i < found.count; ++i) {
      dynamics::Contact& contact = overlaps_.emplace_back(law);
      contact.normal = from_bullet(found.normal);
      contact.point = from_bullet(found.points[i].on_b);
      contact.gap = found.points[i].distance;
    }
  }
  return overlaps_;
}

}  // namespace ziggurat::physics
