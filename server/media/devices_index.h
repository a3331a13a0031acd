// SPDX-License-Identifier: MIT
#pragma once
// Spatial index of the devices of all media at one tick. One index holds devices that send to
// others, another one those that cameras see. It is built anew where something moved.

#include <cstddef>
#include <vector>

#include "media/spatial_index.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::media {

class DevicesIndex {
 public:
  /// LEDs, directional LEDs and tags are indexed if a camera detects them.
  explicit DevicesIndex(const world::Layout& layout);

  /// Takes the poses of a tick.
  void build(const world::State& state);

  // The range of each kind among all devices; empty if it is not indexed.
  world::Range radios, range_and_bearing, leds, directional_leds, tags;

  /// In W [m]; of what is absent not a number.
  const math::Vector3& position(const world::Range& kind, std::size_t device) const {
    return positions_[kind.begin + device];
  }

  /// Radios or range-and-bearing devices strictly closer to `center` than `radius`, ascending.
  /// @param found  emptied before; positions in the kind's list in Layout
  void find(const world::Range& kind, const math::Vector3& center, double radius,
            std::vector<std::size_t>& found) const;

  /// LEDs, directional LEDs or tags in the box from `low` to `high`, its surface included; as
  /// above.
  void find(const world::Range& kind, const math::Vector3& low, const math::Vector3& high,
            std::vector<std::size_t>& found) const;

 private:
  std::vector<world::Mount> mounts_;  // of all devices: those that send, then what is seen
  std::size_t senders_ = 0;
  std::vector<double> ranges_;  // of those that send [m]
  double visible_cell_ = 1;     // [m]
  bool built_ = false;
  std::vector<math::Vector3> positions_;
  SpatialIndex sending_, visible_;
};

/// Whether a receiver at this distance hears a sender of this range [m]: strictly closer. Less than
/// a nanometre counts as nothing, so that the rounding of poses does not decide at the edge.
bool reaches(double range, double distance);

}  // namespace ziggurat::media
