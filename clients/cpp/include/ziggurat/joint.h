#pragma once
// A joint of a robot: its encoder, its motor, or both.

#include <string>

namespace ziggurat {

/// What an encoder measures or a motor controls.
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
  JointMode encoder_mode() const noexcept { return encoder_mode_; }
  /// The reading at the session's tick, in the unit of encoder_mode(); 0 at tick 0 and without an
  /// encoder.
  double encoder() const noexcept { return encoder_; }

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
  bool has_encoder_ = false;
  double encoder_ = 0;
  double* target_ = nullptr;  // into the session's packed command
  bool* changed_ = nullptr;   // the session's: some target was set after the last answer
};

}  // namespace ziggurat
