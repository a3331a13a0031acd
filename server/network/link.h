#pragma once
// How the barrier and its peers reach each other: one connection is one routing id.

#include <chrono>
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

/// Sends a message over the connection with this routing id, without waiting.
using Send = std::function<Delivery(const std::string& connection, const wire::Outbox& message)>;

/// A message of a peer.
struct Received {
  std::string connection;       ///< its routing id
  std::string_view bytes;       ///< valid until the next message is received
  bool is_single_frame = true;  ///< a message of the protocol is one ZeroMQ frame
  Roles roles = all_roles;      ///< that the connection may have
};

}  // namespace ziggurat::network
