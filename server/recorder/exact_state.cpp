#include "recorder/exact_state.h"

#include <cstring>

namespace ziggurat::recorder {

void StateChanges::fill(const world::State& from, v1::ExactState& to) {
  to.Clear();
  to.set_tick(from.tick);
  to.set_is_complete(before_.size() != from.links.size());
  before_.resize(from.links.size());
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    const world::LinkState& link = from.links[i];
    const math::Vector3 &p = link.pose.position, &v = link.velocity, &w = link.angular_velocity;
    const math::Quaternion& q = link.pose.orientation;
    const Link values{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(),
                      v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
    if (!to.is_complete()) {
      if (std::memcmp(values.data(), before_[i].data(), sizeof values) == 0) continue;
      to.add_links(static_cast<std::uint32_t>(i));
    }
    before_[i] = values;
    to.mutable_values()->Add(values.begin(), values.end());
  }
}

}  // namespace ziggurat::recorder
