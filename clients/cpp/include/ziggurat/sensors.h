// SPDX-License-Identifier: MIT
#pragma once
// Sensors of a robot. Readings belong to the session's tick.

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat {

/// A ray that measures the distance to the first object. A handle into its session, valid while the
/// session lives.
class ProximitySensor {
 public:
  /// Id of the link that carries it, or `origin`.
  const std::string& anchor() const noexcept { return anchor_; }
  /// Start of the ray in the anchor's frame: x, y, z [m].
  const std::array<double, 3>& position() const noexcept { return position_; }
  /// Direction of the ray in the anchor's frame: x, y, z, of length 1.
  const std::array<double, 3>& direction() const noexcept { return direction_; }
  double range() const noexcept { return range_; }  ///< length of the ray [m]
  /// Direction of the ray about the robot's +z from +x, in (-pi, pi] [rad]. Only the foot-bot's own
  /// sensors have one.
  std::optional<double> angle() const noexcept { return angle_; }

  /// From 0 (nothing in range) to 1 (contact); exp(-distance in metres) unless the scene has
  /// another response.
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

/// The heading of a body: from the world's x axis to the body's, seen from above, in (-pi, pi]
/// [rad].
/// @param orientation  unit quaternion w, x, y, z, body to world
inline double yaw_of(const std::array<double, 4>& orientation) {
  const auto [w, x, y, z] = orientation;
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/// The pose of the robot's origin in the world.
struct Positioning {
  std::array<double, 3> position{};  ///< x, y, z [m]
  std::array<double, 4> orientation{1, 0, 0,
                                    0};  ///< unit quaternion w, x, y, z, robot to world; w >= 0
  double yaw() const { return yaw_of(orientation); }  ///< (-pi, pi] [rad]
};

struct Battery {
  double available_charge = 0;  ///< share of the full charge, in [0, 1]
  double time_left = 0;         ///< at the rate of the last tick [s]; may be infinite
};

/// An accelerometer and a gyroscope. A handle into its session, valid as long as that lives.
class Imu {
 public:
  const std::string& id() const noexcept { return id_; }
  /// Anchor that it is fixed to: id of a link, or `origin`.
  const std::string& anchor() const noexcept { return anchor_; }
  /// In the anchor's frame: x, y, z [m].
  const std::array<double, 3>& position() const noexcept { return position_; }
  /// In the anchor's frame: unit quaternion w, x, y, z.
  const std::array<double, 4>& orientation() const noexcept { return orientation_; }

  /// As an accelerometer feels it, in the sensor's frame, mean over the last tick: x, y, z [m/s^2].
  /// At rest it points up with the strength of gravity, in free fall it is 0.
  const std::array<double, 3>& acceleration() const noexcept { return reading_.acceleration; }
  /// Relative to the world, in the sensor's frame, mean over the last tick: x, y, z [rad/s].
  const std::array<double, 3>& angular_velocity() const noexcept {
    return reading_.angular_velocity;
  }

 private:
  friend struct Layout;
  struct Reading {
    std::array<double, 3> acceleration{}, angular_velocity{};
  };
  std::string id_, anchor_;
  std::array<double, 3> position_{};
  std::array<double, 4> orientation_{1, 0, 0, 0};
  Reading reading_;
};

/// Feels what touches a link. A handle into its session, valid while the session lives.
class ContactSensor {
 public:
  const std::string& id() const noexcept { return id_; }
  /// Id of the link, or `origin` for the robot's root link.
  const std::string& anchor() const noexcept { return anchor_; }

  /// Something touched the link in the last tick.
  bool touches() const noexcept { return reading_.touches != 0; }
  /// Sum of the forces of all contacts on the link, in its frame, mean over the tick: x, y, z [N].
  const std::array<double, 3>& force() const noexcept { return reading_.force; }
  /// Sum of the absolute values of these forces [N]: more than that of force() where contacts press
  /// against each other.
  double strength() const noexcept { return reading_.strength; }

 private:
  friend struct Layout;
  struct Reading {
    double touches = 0;
    std::array<double, 3> force{};
    double strength = 0;
  };
  std::string id_, anchor_;
  Reading reading_;
};

/// The sensors of a robot that its controller enables, in scene order.
class Sensors {
 public:
  std::span<const ProximitySensor> proximity_sensors() const noexcept { return proximity_; }
  /// Null without such a sensor.
  const Positioning* positioning() const noexcept {
    return positioning_ ? &*positioning_ : nullptr;
  }
  /// Null without one.
  const Battery* battery() const noexcept { return battery_ ? &*battery_ : nullptr; }
  std::span<const Imu> imus() const noexcept { return imus_; }
  /// @throws std::out_of_range, naming those there are
  const Imu& imu(std::string_view id) const;
  std::span<const ContactSensor> contact_sensors() const noexcept { return contact_sensors_; }
  const ContactSensor& contact_sensor(std::string_view id) const;  ///< throws as above

 private:
  friend struct Layout;
  std::vector<ProximitySensor> proximity_;
  std::optional<Positioning> positioning_;
  std::optional<Battery> battery_;
  std::vector<Imu> imus_;
  std::vector<ContactSensor> contact_sensors_;
};

}  // namespace ziggurat
