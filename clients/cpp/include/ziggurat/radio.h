// SPDX-License-Identifier: MIT
#pragma once
// A radio of a robot: messages of any bytes to all radios in range, no addresses.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ziggurat {

/// The content of messages and packets. May be empty.
using Bytes = std::span<const std::uint8_t>;

class RadioTraffic;

/// A handle into its session, valid while the session lives.
class Radio {
 public:
  // Limits of what a robot sends at one tick.
  static constexpr std::size_t max_message_bytes = std::size_t{1} << 20;     ///< in one message
  static constexpr std::size_t max_bytes_per_robot = std::size_t{16} << 20;  ///< by all its radios
  static constexpr std::size_t max_messages_per_robot = std::size_t{1}
                                                        << 16;  ///< by all its radios

  const std::string& id() const noexcept { return id_; }
  /// Radios of the same medium that are closer than this receive its messages [m].
  double range() const noexcept { return range_; }

  /// The controller has a sensor for radios.
  bool receives() const noexcept { return receives_; }
  /// Messages received in the last tick: by sender in scene order, then in the order of sending.
  /// They and their bytes are valid until the session's next(). Empty if it does not receive.
  std::span<const Bytes> received() const noexcept { return received_; }

  /// The controller has an actuator for radios.
  bool sends() const noexcept { return traffic_ != nullptr; }
  /// Sends a copy of the message with the answer to this tick; others receive it at the next. Each
  /// call sends a message.
  /// @throws std::length_error beyond the limits above, or if the session sends more at one tick
  /// than a message to the server can hold; std::logic_error if it does not send
  void send(Bytes message);

 private:
  friend struct Layout;
  std::string id_;
  double range_ = 0;
  bool receives_ = false;
  std::vector<Bytes> received_;      // into the session's observation
  RadioTraffic* traffic_ = nullptr;  // the session's
  std::uint32_t index_ = 0;          // among the radios of the session
  std::uint32_t robot_ = 0;          // position in the session
};

}  // namespace ziggurat
