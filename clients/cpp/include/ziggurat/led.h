#pragma once
// LEDs and directional LEDs of a robot.

#include <cstdint>
#include <string>

namespace ziggurat {

/// Black is off: cameras do not see it.
struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Color&) const = default;
};

/// A handle into its session, valid while the session lives.
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

}  // namespace ziggurat
