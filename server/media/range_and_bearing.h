// SPDX-License-Identifier: MIT
#pragma once
// Range and bearing: each device sends its data at every tick. A device that is strictly closer
// than the sender's range, is in sight and has packets of the same size learns where the sender is.

#include <cstddef>
#include <vector>

#include "media/devices_index.h"
#include "world/layout.h"
#include "world/limits.h"
#include "world/state.h"

namespace ziggurat::media {

/// A sender within reach of a receiver, whether anything is in between or not.
struct Sighting {
  std::size_t sender = 0, receiver = 0;  ///< into Layout::range_and_bearing
};

class RangeAndBearingMedium {
 public:
  /// @param most  pairs at a tick: each takes memory
  explicit RangeAndBearingMedium(std::size_t most = world::most_pairs_in_range) : most_(most) {}

  /// All pairs, ascending by receiver, then sender; valid until the next call.
  /// @throws std::runtime_error if there are too many
  const std::vector<Sighting>& sight(const world::Layout& layout, const DevicesIndex& index);

 private:
  std::size_t most_;
  std::vector<Sighting> by_sender_, by_receiver_;
  std::vector<std::size_t> places_;
  std::vector<std::size_t> found_;
};

/// Range and bearing of a point in a frame.
struct Bearing {
  double range = 0;       ///< [m]
  double horizontal = 0;  ///< about +z from +x, (-pi, pi] [rad]
  double vertical = 0;    ///< above the xy plane, [-pi/2, pi/2] [rad]
};

/// @param point  in the frame [m]
Bearing bearing_of(const math::Vector3& point);

}  // namespace ziggurat::media
