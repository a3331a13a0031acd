// SPDX-License-Identifier: MIT
#pragma once
// The rotating turret of a robot.

#include <cstdint>

namespace ziggurat {

/// Control mode of a turret.
enum class TurretMode : std::uint8_t {
  passive,   ///< with the robot; the initial mode
  position,  ///< to set_rotation()
  speed,     ///< at set_rotation_speed()
};

/// A handle into its session, valid while the session lives. Values that are set are sent with the
/// answer to this tick and stay until changed; they do not change the mode.
class Turret {
 public:
  /// The controller has an actuator for it. Otherwise the setters throw std::logic_error.
  bool drives() const noexcept { return mode_ != nullptr; }
  void set_mode(TurretMode mode);
  /// Relative to the robot, about its +z [rad].
  /// @throws std::invalid_argument if not finite
  void set_rotation(double rotation);
  /// Relative to the robot, about its +z [rad/s].
  /// @throws std::invalid_argument if not finite
  void set_rotation_speed(double speed);

  /// The controller has an encoder for it.
  bool measures() const noexcept { return measures_; }
  /// Relative to the robot at the session's tick, in [-π, π] [rad]; 0 if it does not measure.
  double rotation() const noexcept { return rotation_; }

 private:
  friend struct Layout;
  bool measures_ = false;
  double rotation_ = 0;

  // Into the session's packed commands.
  int* mode_ = nullptr;  // as in messages
  double* target_ = nullptr;
  double* speed_ = nullptr;
  bool* mode_changed_ = nullptr;
  bool* target_changed_ = nullptr;
  bool* speed_changed_ = nullptr;
};

}  // namespace ziggurat
