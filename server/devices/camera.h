#pragma once
// Cameras: each looks for LEDs, directional LEDs and tags at the end of a tick's physics.

#include <cstddef>
#include <span>
#include <vector>

#include "camera/detectors.h"
#include "devices/tick.h"

namespace ziggurat::devices {

class Cameras {
 public:
  explicit Cameras(const Setting& setting) { add(setting); }

  void add(const Setting& setting);

  bool detects() const { return detects_; }  ///< then rays and index are needed

  /// Replaces the readings of all cameras.
  void sense(Tick& tick);

 private:
  void sense(Tick& tick, std::size_t robot, std::size_t camera);

  bool detects_ = false;
  std::vector<std::size_t> found_;
  std::vector<std::size_t> colliders_;  // about one camera
};

/// Whether nothing stands between a camera and a point, both in W [m]: anything but the floor is in
/// the way, the camera's robot and the carrier of what is at the point included; not what is met
/// within 0.1 mm of the point, nor a body that the camera is inside of.
struct Sight {
  const physics::Rays& rays;
  std::size_t robot;                       ///< into Layout::robots: whose camera it is
  std::vector<world::Ray>* shown;          ///< gets the tested rays; may be null
  std::span<const std::size_t> colliders;  ///< all that can be in the way, if there are few
  bool few;

  bool clear(const math::Vector3& eye, const math::Vector3& target) const;
};

}  // namespace ziggurat::devices
