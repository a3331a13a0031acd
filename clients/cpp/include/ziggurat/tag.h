#pragma once
// A tag of a robot; the robot may change its payload.

#include <cstddef>
#include <string>
#include <string_view>

namespace ziggurat {

/// A handle into its session, valid while the session lives.
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

}  // namespace ziggurat
