#pragma once
// Cameras: each looks for LEDs, directional LEDs and tags at the end of a tick's physics.

#include <cstddef>
#include <vector>

#include "camera/detectors.h"
#include "devices/tick.h"

namespace ziggurat::devices {

class Cameras {
 public:
  explicit Cameras(const Setting& setting);

  bool detects() const { return detects_; }  ///< then rays and index are needed

  /// Replaces the readings of all cameras.
  void sense(Tick& tick);

 private:
  void sense(Tick& tick, std::size_t robot, std::size_t camera);

  bool detects_ = false;
  std::vector<std::size_t> found_;
};

/// Whether nothing stands between a camera and a point, both in W [m]: anything but the floor is in
/// the way, the camera's robot and the carrier of what is at the point included; not what is met
/// within 0.1 mm of the point, nor a body that the camera is inside of.
/// @param shown  gets the tested ray if given; @param robot  whose
bool line_of_sight(const physics::Rays& rays, const math::Vector3& eye, const math::Vector3& target,
                   std::size_t robot, std::vector<world::Ray>* shown);

}  // namespace ziggurat::devices
