#pragma once
// Where the devices of all media are at one tick, found by place: one index for all of them, built
// once per tick.

#include <cstddef>
#include <vector>

#include "media/spatial_index.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::media {

class DevicesIndex {
 public:
  /// Keeps a reference to `layout`.
  /// @param with_visible  also LEDs, directional LEDs and tags: somebody looks at them
  DevicesIndex(const world::Layout& layout, bool with_visible);

  /// Takes the poses of a tick.
  void build(const world::State& state);

  // Each kind's stretch in `positions`; empty if nobody asks for it.
  world::Range radios, range_and_bearing, leds, directional_leds, tags;

  /// Of all devices that are indexed, in W [m].
  const std::vector<math::Vector3>& positions() const { return positions_; }
  const math::Vector3& position(const world::Range& kind, std::size_t device) const {
    return positions_[kind.begin + device];
  }

  /// Devices of a kind strictly closer to `center` than `radius`, ascending.
  /// @param found  emptied before; positions in the kind's list in Layout
  void find(const world::Range& kind, const math::Vector3& center, double radius,
            std::vector<std::size_t>& found) const;

 private:
  std::vector<world::Mount> mounts_;  // of all devices
  std::vector<double> ranges_;        // of those that send [m]
  std::vector<math::Vector3> positions_;
  SpatialIndex index_;
};

/// Whether a receiver at this distance hears a sender of this range [m]: strictly closer. Less than
/// a nanometre counts as nothing, so that the rounding of poses does not decide at the edge.
bool reaches(double range, double distance);

}  // namespace ziggurat::media
