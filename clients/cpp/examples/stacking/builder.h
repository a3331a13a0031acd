#pragma once
// The construction robot's body as its controller uses it: wheels, lift, magnets, proximity sensors
// and docking at a block by the camera. Positions are forward and left of the point between the
// four wheels.

#include <ziggurat/ziggurat.h>

#include <array>
#include <cstddef>
#include <optional>

namespace stacking {

inline constexpr double tick = 0.1;     ///< between two steps [s]
inline constexpr double block = 0.055;  ///< edge of a block [m]

/// The side of a block that is seen.
struct Face {
  double forward = 0;  ///< of its middle [m]
  double left = 0;     ///< [m]
  double heading = 0;  ///< direction into the face, from straight ahead to the left [rad]

  /// How far the robot stands to the left of the line through its middle, at right angles to it
  /// [m].
  double offset() const;
};

enum class Docking { under_way, docked, lost, askew };

class Builder {
 public:
  explicit Builder(ziggurat::Robot& robot);

  /// @param speed  [m/s];  @param turn  to the left [rad/s]
  void drive(double speed, double turn);
  void stop() { drive(0, 0); }

  /// Sends the lift to a height [m] at up to this speed [m/s]. True once it is there.
  bool lift_to(double height, double speed);
  /// Moves the lift on, or holds it; to be called at every step, last.
  void move_lift();

  /// -1 cancels the end effector's permanent magnets, 0 leaves them, +1 doubles them.
  void set_current(double current);
  /// Whether a block hangs at the end effector: all sensors that look down touch it.
  bool holds() const;
  /// To the block that hangs there.
  void send(std::uint8_t byte);

  /// At floor level, towards the robot; nothing if none is seen.
  std::optional<Face> nearest_face() const;
  /// Drives up to the nearest face; to be called at every step. `askew` if it came close without
  /// being in line, `lost` if there is none to drive up to.
  Docking dock(double fastest);
  /// Backs away along the line before the nearest face. How far away that is [m]; 0 if unseen.
  double back_away(double speed);

 private:
  double distance(std::size_t sensor) const;
  double ahead() const;

  const ziggurat::Camera& camera_;
  std::array<ziggurat::Joint*, 2> left_wheels_;
  std::array<ziggurat::Joint*, 2> right_wheels_;
  ziggurat::Joint& lift_;
  ziggurat::Radio& radio_;
  std::span<ziggurat::Magnet> magnets_;
  std::span<const ziggurat::ProximitySensor> proximity_;
  double lift_height_ = 0;       // it is sent to [m]
  double lift_speed_limit_ = 0;  // [m/s]
  double lift_speed_ = 0;        // now [m/s]
  int unseen_ = 0;               // steps since a face was seen
};

}  // namespace stacking
