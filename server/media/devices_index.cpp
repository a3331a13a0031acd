#include "media/devices_index.h"

namespace ziggurat::media {
namespace {

constexpr double rounding = 1e-9;  // [m]

template <class List>
world::Range append(const List& list, bool wanted, std::vector<world::Mount>& mounts) {
  const world::Range range{mounts.size(), wanted ? list.size() : 0};
  if (wanted) {
    for (const auto& device : list) mounts.push_back(device.mount);
  }
  return range;
}

}  // namespace

bool reaches(double range, double distance) { return distance < range - rounding; }

DevicesIndex::DevicesIndex(const world::Layout& layout, bool with_visible) {
  radios = append(layout.radios, true, mounts_);
  range_and_bearing = append(layout.range_and_bearing, true, mounts_);
  leds = append(layout.leds, with_visible, mounts_);
  directional_leds = append(layout.directional_leds, with_visible, mounts_);
  tags = append(layout.tags, with_visible, mounts_);
  positions_.resize(mounts_.size());
  for (const auto& radio : layout.radios) ranges_.push_back(radio.range);
  for (const auto& device : layout.range_and_bearing) ranges_.push_back(device.range);
}

void DevicesIndex::build(const world::State& state) {
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    positions_[i] = world::position_of(state, mounts_[i]);
  }
  index_.build(positions_, ranges_);
}

void DevicesIndex::find(const world::Range& kind, const math::Vector3& center, double radius,
                        std::vector<std::size_t>& found) const {
  index_.find(center, radius, kind.begin, kind.end(), found);
  for (std::size_t& device : found) device -= kind.begin;
}

}  // namespace ziggurat::media
