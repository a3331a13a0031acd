// SPDX-License-Identifier: MIT
#pragma once
// A joint of a robot: its encoder, its motor, or both.

#include <string>

namespace ziggurat {

/// Quantity that an encoder measures or a motor controls.
enum class JointMode {
  disabled,  ///< the encoder is 0; targets have no effect
  position,  ///< [m] (prismatic) or [rad] (revolute), from the assembled pose
  velocity,  ///< [m/s] or [rad/s]
};

/// A handle into its session, valid while the session lives. Reading and setting take O(1) and
/// allocate nothing.
class Joint {
 public:
  const std::string& id() const noexcept { return id_; }

  bool has_encoder() const noexcept { return has_encoder_; }
  /// The mode of the sensor that the scene lists first.
  JointMode encoder_mode() const noexcept { return encoder_mode_; }
  /// The reading of that sensor at the session's tick, in the unit of encoder_mode(); 0 at tick 0
  /// and without an encoder.
  double encoder() const noexcept {
    return encoder_mode_ == JointMode::velocity   ? velocity_
           : encoder_mode_ == JointMode::position ? position_
                                                  : other_;
  }

  /// Whether the scene's controller has a sensor of this joint in mode position, velocity. A joint
  /// may have both.
  bool has_position() const noexcept { return has_position_; }
  bool has_velocity() const noexcept { return has_velocity_; }
  /// Their readings [m or rad], [m/s or rad/s]; 0 at tick 0. @throws std::logic_error without that
  /// sensor
  double position() const;
  double velocity() const;

  bool has_motor() const noexcept { return target_ != nullptr; }
  JointMode motor_mode() const noexcept { return motor_mode_; }
  /// Largest impulse per physics substep, from the scene [N s] or [N m s].
  double max_impulse() const noexcept { return max_impulse_; }
  /// In the unit of motor_mode(); sent with the answer to this tick, takes effect at the start of
  /// the next, and stays until changed.
  /// @throws std::invalid_argument if not finite; std::logic_error without a motor
  void set_target(double target);
  /// The last target set; 0 before the first and without a motor.
  double target() const noexcept { return target_ == nullptr ? 0.0 : *target_; }

 private:
  friend struct Layout;
  std::string id_;
  JointMode encoder_mode_ = JointMode::disabled;
  JointMode motor_mode_ = JointMode::disabled;
  double max_impulse_ = 0;
  bool has_encoder_ = false, has_position_ = false, has_velocity_ = false;
  double position_ = 0, velocity_ = 0;  // readings
  double other_ = 0;                    // the reading of a sensor that is disabled
  double* target_ = nullptr;            // into the session's packed command
  bool* changed_ = nullptr;             // the session's: some target was set after the last answer
};

}  // namespace ziggurat
