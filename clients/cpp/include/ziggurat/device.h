// SPDX-License-Identifier: MIT
#pragma once
// Devices that describe themselves: the server tells the names and units of their values.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat {

struct DeviceValues;

/// A value that devices of a kind have.
struct DeviceField {
  std::string name;
  std::string unit;  ///< empty: a number without unit; `0xRRGGBB`: a colour
};

/// A value that can be commanded.
struct DeviceCommand : DeviceField {
  double least = 0, most = 0;  ///< may be infinite
  double initial = 0;
};

/// Description of a kind of device.
struct DeviceKind {
  std::string name;                   ///< of its element in the scene
  std::vector<DeviceField> readings;  ///< of each device, or of each of its rows
  std::vector<DeviceField> properties;
  std::vector<DeviceCommand> commands;
  bool reads_rows = false;  ///< its devices read any number of rows
};

/// A handle into its session, valid while the session lives.
class Device {
 public:
  const DeviceKind& kind() const noexcept { return *kind_; }
  const std::string& id() const noexcept { return id_; }  ///< may be empty
  /// Anchor that it is fixed to: id of a link, or `origin`.
  const std::string& anchor() const noexcept { return anchor_; }
  /// In the anchor's frame: x, y, z [m].
  const std::array<double, 3>& position() const noexcept { return position_; }
  /// In the anchor's frame: unit quaternion w, x, y, z.
  const std::array<double, 4>& orientation() const noexcept { return orientation_; }

  /// All readings in the order of kind().readings; none if the kind reads rows.
  std::span<const double> readings() const noexcept;
  /// @throws std::out_of_range, naming those there are
  double reading(std::string_view name) const;
  /// A value that does not change; throws as above.
  double property(std::string_view name) const;
  const std::vector<double>& properties() const noexcept { return properties_; }

  /// Number of rows that it reads; 0 if the kind reads none.
  std::size_t row_count() const noexcept;
  /// A row in the order of kind().readings, valid until the next tick.
  /// @param index  < row_count()
  std::span<const double> row(std::size_t index) const noexcept;

  /// Sent with the answer to this tick; stays until changed.
  /// @throws std::out_of_range without such a command, naming those there are,
  /// std::invalid_argument if the value is not finite or not within its limits
  void set(std::string_view name, double value);
  /// The last value set; before that, the initial one. Throws as reading().
  double commanded(std::string_view name) const;

 private:
  friend struct Layout;
  const DeviceKind* kind_ = nullptr;  // of its robot
  std::string id_, anchor_;
  std::array<double, 3> position_{};
  std::array<double, 4> orientation_{1, 0, 0, 0};
  std::vector<double> properties_;
  const DeviceValues* values_ = nullptr;  // of the session
  std::size_t place_ = 0;                 // of its readings, or of its rows
  std::vector<double*> commands_;         // into the session's packed command
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
