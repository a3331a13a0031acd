#pragma once
// Proximity sensors: rays that read how close the nearest foreign body is.

#include <vector>

#include "devices/tick.h"
#include "math/random.h"

namespace ziggurat::devices {

/// What a sensor reads of something at a distance [m]; exp(-distance) without a response.
double proximity_reading(double distance, const scene::Response* response);

/// What the foot-bot's own sensor reads of it.
double footbot_proximity_reading(double distance);

class Proximity {
 public:
  explicit Proximity(const Setting& setting) { add(setting); }

  void add(const Setting& setting);
  void start(Tick& tick) const;  ///< readings that are new are 0
  void sense(Tick& tick);

  bool casts_rays() const { return !sensors_.empty(); }

 private:
  struct Sensor {
    std::optional<scene::Response> response;
    bool footbot = false;  // has the foot-bot's own response
    bool sees_floor = false;
    double least = 0, most = 1;  // of readings with noise
  };
  struct Robot {
    std::size_t index;  // into Layout::robots
    double noise;       // uniform in ± this
    bool shows_rays;
    math::RandomStream random;
  };

  void sense(Tick& tick, Robot& robot);

  std::vector<Sensor> sensors_;  // parallel to Layout::proximity
  std::vector<Robot> robots_;    // that have sensors
};

}  // namespace ziggurat::devices
