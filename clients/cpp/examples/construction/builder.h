// SPDX-License-Identifier: MIT
#pragma once
// The construction robot for its controllers: wheels, lift, magnets, proximity sensors, and docking
// at a block with the camera. Positions are forward and left of the point between the four wheels.

#include <ziggurat/ziggurat.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace construction {

inline constexpr double tick = 0.1;     ///< between two steps [s]
inline constexpr double block = 0.055;  ///< edge of a block [m]
/// From the robot's centre to the face of a block under the end effector [m].
inline constexpr double reach = 0.080;

/// The side of a block that the camera sees.
struct Face {
  double forward = 0;        ///< of its centre [m]
  double left = 0;           ///< [m]
  double heading = 0;        ///< direction into the face, from straight ahead to the left [rad]
  double up = 0;             ///< above the camera [m]
  std::string_view payload;  ///< of its tag; valid until the session's next()
  std::optional<ziggurat::Color> color;  ///< of its LEDs; none if they are off

  /// Distance of the robot to the left of the face's normal through its centre [m].
  /// @param ahead  of the point that is so far in front of the robot's centre [m]
  double offset(double ahead = 0) const;
};

/// The side of a block that stands on the floor.
bool is_at_floor_level(const Face& face);

/// Sensors that measure the distance to a face in front.
enum class Ranging { camera, proximity };

enum class Docking { under_way, docked, lost, askew };

class Builder {
 public:
  explicit Builder(ziggurat::Robot& robot);

  /// Wheels skid more under a block's weight: whether the robot carries one.
  bool loaded = false;

  /// @param speed  [m/s];  @param turn  to the left [rad/s]
  void drive(double speed, double turn);
  void stop() { drive(0, 0); }
  double speed() const;  ///< by the rotation of the wheels [m/s]

  /// Moves the lift to a height [m] with at most this speed [m/s]. True when it has arrived.
  bool lift_to(double height, double speed);
  /// Moves or holds the lift; call it last in every step.
  void move_lift();
  double lift_height() const { return lift_.encoder(); }  ///< [m]

  /// -1 cancels the end effector's permanent magnets, 0 leaves them, +1 doubles them.
  void set_current(double current);
  /// A block is attached to the end effector: all sensors that look down touch it.
  bool holds() const;
  /// To the attached block.
  void send(ziggurat::Bytes message) { radio_.send(message); }
  /// From the attached block. Valid until the session's next().
  std::span<const ziggurat::Bytes> received() const { return radio_.received(); }

  /// @param sensor  from 1, as in the scene's comments and in the Lua script
  /// @return of the object from a proximity sensor [m]; infinite if there is none
  double distance(std::size_t sensor) const;
  double ahead() const;  ///< from the robot's centre to the nearest object before the deck [m]
  double below() const;  ///< from the end effector's face to the object below it [m]

  /// All upright faces that the camera sees, the nearest first.
  std::vector<Face> faces() const;
  /// At floor level, facing the robot; none if the camera sees none.
  std::optional<Face> nearest_face() const;
  /// Drives to the nearest face; call it in every step. `askew`: the robot came close but is not on
  /// the line, or is too far aside for the way that is left. The same holds if the face left the
  /// image and the camera sees another. `lost`: it sees none.
  Docking dock(double fastest);
  /// Drives to this face, until it is at this distance from the robot's centre [m]; call it in
  /// every step. `askew` if the robot came close but is not on the line.
  /// @param ranging  of the last part of the distance
  /// @param pivot  how far in front of the robot's centre the point is about which it turns [m], if
  /// that
  ///               is known
  Docking dock_at(const Face& face, double fastest, Ranging ranging, double distance = reach,
                  std::optional<double> pivot = {});
  /// Drives backwards to the line in front of the nearest face; call it in every step. True where
  /// an approach is easy: 20 cm away and near the line, or far away.
  bool back_away(double speed);
  /// The next face to drive to may be any.
  void forget_face();

 private:
  std::optional<Face> tracked_face(bool& another);

  const ziggurat::Camera& camera_;
  std::array<ziggurat::Joint*, 2> left_wheels_;  // front, back
  std::array<ziggurat::Joint*, 2> right_wheels_;
  ziggurat::Joint& lift_;
  ziggurat::Radio& radio_;
  std::span<ziggurat::Magnet> magnets_;
  std::span<const ziggurat::ProximitySensor> proximity_;
  double lift_height_ = 0;                                    // target [m]
  double lift_speed_limit_ = 0;                               // [m/s]
  double lift_speed_ = 0;                                     // present [m/s]
  int unseen_ = 0;                                            // steps since the camera saw a face
  double tracked_ = std::numeric_limits<double>::infinity();  // distance of that face [m]
};

}  // namespace construction
