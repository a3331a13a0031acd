#pragma once
// Range and bearing: packets of everybody in reach and sight, with noise and loss.

#include <optional>
#include <vector>

#include "devices/tick.h"
#include "math/random.h"
#include "media/range_and_bearing.h"

namespace ziggurat::devices {

class RangeAndBearing {
 public:
  explicit RangeAndBearing(const Setting& setting) { add(setting); }

  void add(const Setting& setting);
  void sense(Tick& tick);

  bool casts_rays() const { return casts_rays_; }
  bool needs_index() const { return needs_index_; }

 private:
  struct Receiver {
    std::size_t robot = 0;  // into Layout::robots
    double noise = 0;       // standard deviation of each coordinate of a sender [m]
    double loss = 0;        // probability
    bool shows_rays = false;
    bool checks_occlusions = true;
    math::RandomStream random;
  };

  void receive(Tick& tick, const media::Sighting& pair, Receiver& receiver);

  media::RangeAndBearingMedium medium_;
  std::vector<std::optional<Receiver>> receivers_;  // parallel to Layout::range_and_bearing
  bool casts_rays_ = false;
  bool needs_index_ = false;
};

}  // namespace ziggurat::devices
