// SPDX-License-Identifier: MIT
#include "media/devices_index.h"

#include <algorithm>
#include <limits>
#include <span>

namespace ziggurat::media {
namespace {

constexpr double rounding = 1e-9;                                     // [m]
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();  // never found

template <class List>
world::Range append(const List& list, std::vector<world::Mount>& mounts) {
  const world::Range range{mounts.size(), list.size()};
  for (const auto& device : list) mounts.push_back(device.mount);
  return range;
}

/// Half the length of what a camera sees, or of its width or height if that is more [m].
double reach(const world::CameraLayout& camera) {
  double longest = camera.far - camera.near;
  for (int axis = 0; axis < 2; ++axis) {
    longest = std::max(longest, camera.resolution[axis] / camera.focal_length[axis] * camera.far);
  }
  return longest / 2;
}

}  // namespace

bool reaches(double range, double distance) { return distance < range - rounding; }

DevicesIndex::DevicesIndex(const world::Layout& layout) {
  using Camera = world::CameraLayout;
  const auto append_detected = [&](const auto& list, auto detector) {
    const bool is_detected = std::ranges::any_of(
        layout.cameras, [&](const Camera& camera) { return (camera.*detector).has_value(); });
    return is_detected ? append(list, mounts_) : world::Range{mounts_.size(), 0};
  };
  radios = append(layout.radios, mounts_);
  range_and_bearing = append(layout.range_and_bearing, mounts_);
  senders_ = mounts_.size();
  std::vector<double> reaches;
  for (const world::DescribedDevice& device : layout.described) {
    if (device.sight > 0) reaches.push_back(device.sight);
  }
  leds = append_detected(layout.leds, &Camera::leds);
  if (leds.count == 0 && !reaches.empty()) leds = append(layout.leds, mounts_);
  directional_leds = append_detected(layout.directional_leds, &Camera::directional_leds);
  tags = append_detected(layout.tags, &Camera::tags);
  positions_.resize(mounts_.size());
  for (const auto& radio : layout.radios) ranges_.push_back(radio.range);
  for (const auto& device : layout.range_and_bearing) ranges_.push_back(device.range);
  // Cells of what cameras see are as large as a usual view, however far apart devices are: then
  // those in other places cost a view nothing.
  for (const Camera& camera : layout.cameras) reaches.push_back(reach(camera));
  std::ranges::sort(reaches);
  if (!reaches.empty()) visible_cell_ = reaches[reaches.size() / 2];
}

void DevicesIndex::build(const world::State& state) {
  bool moved[2] = {!built_, !built_};
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    if (state.is_absent(mounts_[i].entity)) {
      if (positions_[i].hasNaN()) continue;
      positions_[i].setConstant(nowhere);
    } else {
      const math::Vector3 position = world::position_of(state, mounts_[i]);
      if (position == positions_[i]) continue;
      positions_[i] = position;
    }
    moved[i >= senders_] = true;
  }
  built_ = true;
  const std::span all(positions_);
  if (moved[0]) sending_.build(all.first(senders_), ranges_);
  if (moved[1]) visible_.build(all.subspan(senders_), visible_cell_);
}

void DevicesIndex::find(const world::Range& kind, const math::Vector3& center, double radius,
                        std::vector<std::size_t>& found) const {
  sending_.find(center, radius, kind.begin, kind.end(), found);
  for (std::size_t& device : found) device -= kind.begin;
}

void DevicesIndex::find(const world::Range& kind, const math::Vector3& low,
                        const math::Vector3& high, std::vector<std::size_t>& found) const {
  const std::size_t begin = kind.begin - senders_;
  visible_.find(low, high, begin, begin + kind.count, found);
  for (std::size_t& device : found) device -= begin;
}

}  // namespace ziggurat::media
