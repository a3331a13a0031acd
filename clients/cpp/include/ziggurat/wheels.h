// SPDX-License-Identifier: MIT
#pragma once
// The two driven wheels of a robot.

namespace ziggurat {

/// A handle into its session, valid while the session lives.
class Wheels {
 public:
  struct Reading {
    double velocity_left = 0, velocity_right = 0;  ///< as commanded [m/s]
    double distance_left = 0, distance_right = 0;  ///< in the last tick [m]
  };

  double axle_length() const noexcept { return axle_length_; }  ///< between the wheels [m]

  /// The controller has an actuator for them.
  bool drives() const noexcept { return changed_ != nullptr; }
  /// Speeds over the floor [m/s]. Sent with the answer to this tick; stay until changed.
  /// @throws std::invalid_argument if not finite; std::logic_error if it does not drive
  void set_velocity(double left, double right);

  /// The controller has a sensor for them.
  bool measures() const noexcept { return measures_; }
  /// At the session's tick; zeros if it does not measure.
  const Reading& reading() const noexcept { return reading_; }

 private:
  friend struct Layout;
  double axle_length_ = 0;
  bool measures_ = false;
  Reading reading_;
  double* left_ = nullptr;  // into the session's packed command
  double* right_ = nullptr;
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
