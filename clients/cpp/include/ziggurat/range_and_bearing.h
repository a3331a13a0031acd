#pragma once
// Situated communication: a few bytes, broadcast all the time, received with where they come from.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ziggurat/radio.h"

namespace ziggurat {

/// A handle into its session, valid as long as that lives.
class RangeAndBearing {
 public:
  /// One packet, from one other device.
  struct Packet {
    double range = 0;               ///< distance to the sender [m]
    double horizontal_bearing = 0;  ///< in our frame, from +x towards +y, in [-π, π] [rad]
    double vertical_bearing = 0;    ///< above the x-y plane of our frame, in [-π/2, π/2] [rad]
    Bytes data;                     ///< valid until the session's next()
  };

  double range() const noexcept { return range_; }  ///< of sending [m]
  /// Of each packet sent and received [bytes].
  std::size_t data_size() const noexcept { return data_size_; }

  /// The controller has a sensor for it.
  bool receives() const noexcept { return receives_; }
  /// Heard at this tick, by sender in scene order. Valid until the session's next().
  std::span<const Packet> packets() const noexcept { return packets_; }

  /// The controller has an actuator for it.
  bool sends() const noexcept { return changed_ != nullptr; }
  /// Broadcast from the next tick on, until changed.
  /// @throws std::invalid_argument if not data_size() long; std::logic_error if it does not send
  void set_data(Bytes data);
  /// All zeros, as in the beginning.
  /// @throws std::logic_error if it does not send
  void clear_data();
  /// The last data set; zeros before the first. Empty if it does not send.
  Bytes data() const noexcept { return data_; }

 private:
  friend struct Layout;
  double range_ = 0;
  std::size_t data_size_ = 0;
  bool receives_ = false;
  std::vector<Packet> packets_;
  std::span<std::uint8_t> data_;  // into the session's packed command
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
