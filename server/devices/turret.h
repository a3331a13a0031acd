#pragma once
// A rotating turret: passive, held at an angle or turned at a speed, and its encoder.

#include <vector>

#include "devices/tick.h"

namespace ziggurat::devices {

class Turrets {
 public:
  explicit Turrets(const Setting& setting) : tick_length_(setting.tick_length) { add(setting); }

  void add(const Setting& setting);
  void start(Tick& tick) const;  ///< those that are new are passive, at 0
  void apply(Tick& tick);
  void sense(Tick& tick) const;

 private:
  /// The dialect's control of the angle, once per tick.
  /// @return  speed [rad/s]
  double approach(double& last_error, double error) const;

  double tick_length_;               // [s]
  std::vector<double> last_errors_;  // parallel to Layout::turrets; 0 unless in mode position [rad]
};

}  // namespace ziggurat::devices
