// SPDX-License-Identifier: MIT
#pragma once
// Range and bearing: a few bytes, broadcast at every tick; receivers also get the distance and the
// direction of the sender.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ziggurat/radio.h"

namespace ziggurat {

/// A handle into its session, valid while the session lives.
class RangeAndBearing {
 public:
  /// A packet from another device.
  struct Packet {
    double range = 0;  ///< distance to the sender [m]
    double horizontal_bearing =
        0;  ///< in the receiver's frame, from +x towards +y, in [-π, π] [rad]
    double vertical_bearing = 0;  ///< above the receiver's x-y plane, in [-π/2, π/2] [rad]
    Bytes data;                   ///< valid until the session's next()
  };

  double range() const noexcept { return range_; }  ///< of sending [m]
  /// Size of each packet sent and received [bytes].
  std::size_t data_size() const noexcept { return data_size_; }

  /// The controller has a sensor for it.
  bool receives() const noexcept { return receives_; }
  /// Received at this tick, by sender in scene order. Valid until the session's next().
  std::span<const Packet> packets() const noexcept { return packets_; }

  /// The controller has an actuator for it.
  bool sends() const noexcept { return changed_ != nullptr; }
  /// Broadcasts these data from the next tick on, until changed.
  /// @throws std::invalid_argument if not data_size() long; std::logic_error if it does not send
  void set_data(Bytes data);
  /// Sets all bytes to 0, the initial value.
  /// @throws std::logic_error if it does not send
  void clear_data();
  /// The last data set; before that, zeros. Empty if it does not send.
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
