// SPDX-License-Identifier: MIT
#pragma once
// Actuators that hold a value until it is changed: LEDs, directional LEDs, tags and magnets.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ziggurat {

/// Black is off: cameras do not see it.
struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Color&) const = default;
};

/// An LED. Handles are valid while their session lives.
class Led {
 public:
  const std::string& id() const noexcept { return id_; }
  /// Sent with the answer to this tick; stays until changed.
  void set_color(Color color) noexcept;
  /// The last color set; before that, the scene's.
  Color color() const noexcept;

 private:
  friend struct Layout;
  std::string id_;
  std::uint32_t* color_ = nullptr;  // 0xRRGGBB, into the session's packed command
  bool* changed_ = nullptr;
};

/// A tag, whose payload can be changed.
class Tag {
 public:
  static constexpr std::size_t max_payload_bytes = std::size_t{64} << 10;

  const std::string& id() const noexcept { return id_; }
  /// Sets the payload that cameras detect, any bytes. Sent with the answer to this tick; stays
  /// until changed.
  /// @throws std::length_error beyond max_payload_bytes
  void set_payload(std::string_view payload);
  /// The last payload set; before that, the scene's.
  const std::string& payload() const noexcept { return *payload_; }

 private:
  friend struct Layout;
  std::string id_;
  std::string* payload_ = nullptr;  // into the session's packed command
  bool* changed_ = nullptr;
};

/// A magnet with an electromagnetic part.
class Magnet {
 public:
  const std::string& id() const noexcept { return id_; }
  /// The magnet's field is passive + current × active field, both from the scene; any sign.
  /// Sent with the answer to this tick; stays until changed.
  /// @throws std::invalid_argument if not finite
  void set_current(double current);
  /// The last current set; before that, 0.
  double current() const noexcept { return *current_; }

 private:
  friend struct Layout;
  std::string id_;
  double* current_ = nullptr;  // into the session's packed command
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
