#pragma once
// What a robot senses of its surroundings and itself. Readings belong to the session's tick.

#include <array>
#include <optional>
#include <string>

namespace ziggurat {

/// A ray that meets what is in front of it. A handle into its session, valid as long as that
/// lives.
class ProximitySensor {
 public:
  /// Of its mounting: id of a link, or `origin`.
  const std::string& anchor() const noexcept { return anchor_; }
  /// Start of the ray in the anchor's frame: x, y, z [m].
  const std::array<double, 3>& position() const noexcept { return position_; }
  /// Of the ray in the anchor's frame: x, y, z, of length 1.
  const std::array<double, 3>& direction() const noexcept { return direction_; }
  double range() const noexcept { return range_; }  ///< length of the ray [m]
  /// Of the ray about the robot's +z from +x, in (-pi, pi] [rad]; of foot-bots' own sensors, which
  /// are told with it.
  std::optional<double> angle() const noexcept { return angle_; }

  /// From 0, nothing in range, to 1, contact; exp(-distance in metres) unless the scene says
  /// otherwise.
  double reading() const noexcept { return reading_; }

 private:
  friend struct Layout;
  std::string anchor_;
  std::array<double, 3> position_{};
  std::array<double, 3> direction_{};
  double range_ = 0;
  std::optional<double> angle_;
  double reading_ = 0;
};

/// Where the robot is: the pose of its origin in the world.
struct Positioning {
  std::array<double, 3> position{};               ///< x, y, z [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z, robot to world
};

struct Battery {
  double available_charge = 0;  ///< share of the full charge, in [0, 1]
  double time_left = 0;         ///< at the rate of the last tick [s]; may be infinite
};

}  // namespace ziggurat
