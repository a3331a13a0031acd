// SPDX-License-Identifier: MIT
#include "media/range_and_bearing.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace ziggurat::media {

const std::vector<Sighting>& RangeAndBearingMedium::sight(const world::Layout& layout,
                                                          const DevicesIndex& index) {
  const std::vector<world::RangeAndBearingLayout>& devices = layout.range_and_bearing;
  by_sender_.clear();
  places_.assign(devices.size() + 1, 0);
  for (std::size_t sender = 0; sender < devices.size(); ++sender) {
    const auto& from = devices[sender];
    const math::Vector3& place = index.position(index.range_and_bearing, sender);
    index.find(index.range_and_bearing, place, from.range, found_);
    for (const std::size_t receiver : found_) {
      const auto& to = devices[receiver];
      if (receiver == sender || !to.receives || to.medium != from.medium) continue;
      if (to.data.count != from.data.count) continue;
      const double distance = (index.position(index.range_and_bearing, receiver) - place).norm();
      if (!reaches(from.range, distance)) continue;
      if (by_sender_.size() == most_) {
        throw std::runtime_error(
            "more than " + std::to_string(most_) + " pairs of the " +
            std::to_string(devices.size()) +
            " devices of range and bearing reach each other; write a smaller range on "
            "<range_and_bearing>, or fewer robots");
      }
      by_sender_.push_back({sender, receiver});
      ++places_[receiver];
    }
  }
  std::size_t total = 0;
  for (std::size_t& place : places_) total += std::exchange(place, total);
  by_receiver_.resize(total);
  for (const Sighting& pair : by_sender_) by_receiver_[places_[pair.receiver]++] = pair;
  return by_receiver_;
}

Bearing bearing_of(const math::Vector3& point) {
  const double level = std::hypot(point.x(), point.y());
  return {point.norm(), std::atan2(point.y(), point.x()), std::atan2(point.z(), level)};
}

}  // namespace ziggurat::media
