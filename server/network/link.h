// SPDX-License-Identifier: MIT
#pragma once
// Interface between the barrier and its peers. The server names each connection; no other
// connection ever has the same name.

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "network/keys.h"
#include "wire/outbox.h"

namespace ziggurat::network {

/// A moment of wall time. Only the server reads the clock; everything behind it is told the time.
using Time = std::chrono::steady_clock::time_point;
inline constexpr Time never = Time::max();

enum class Delivery {
  sent,
  unreachable,  ///< the connection is gone
  congested,    ///< the peer does not read; the message was dropped
};

/// Kinds of messages that wait: a newer observation takes an older one's place.
enum class MessageKind { observation, other };
inline MessageKind kind_of(const wire::Outbox& message) {
  return message.is_observation() ? MessageKind::observation : MessageKind::other;
}

/// Sends a message over this connection, without waiting.
using Send = std::function<Delivery(const std::string& connection, const wire::Outbox& message)>;

/// A message of a peer.
struct Received {
  std::string connection;
  std::string_view bytes;       ///< valid until the next message is received
  bool is_single_frame = true;  ///< a message of the protocol is one ZeroMQ frame
  Access access = {};           ///< that the connection has
  /// Bytes of the message that were not kept, because a frame was too long or not its last: there
  /// are no others.
  std::size_t skipped = 0;
  /// Encoding of a message of several frames, by its first frame.
  wire::Encoding several_frames = wire::Encoding::binary;
};

}  // namespace ziggurat::network
