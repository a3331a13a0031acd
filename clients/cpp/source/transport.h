// SPDX-License-Identifier: MIT
#pragma once
// Transport of a client's messages to the server and back.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "ziggurat/session.h"

namespace ziggurat {

class Transport {
 public:
  virtual ~Transport() = default;

  /// Sends a message, or queues it while there is no connection yet. Waits while the queue is full.
  /// @param write  fills `size` bytes
  /// @throws ConnectionError  also if the server has refused the connection
  virtual void send(std::size_t size, const std::function<void(char*)>& write) = 0;

  /// Waits for a message.
  /// @return  whether there is one; false after the time-out, after a signal, and when the
  /// connection has changed
  /// @throws ConnectionError
  virtual bool receive(std::chrono::milliseconds timeout) = 0;
  /// The last message, valid until the next is received, and whether it has more frames.
  virtual std::string_view content() = 0;
  virtual bool has_more() const = 0;

  /// Whether the connection was closed after it had been open. It is not opened again, and messages
  /// may be lost. Until it is open, connecting is retried.
  /// @throws ConnectionError if the server does not accept this client's keys, or that it has none
  virtual bool was_closed() = 0;
  /// Whether the server has accepted the connection: if nothing arrives then, the server is slow.
  virtual bool is_accepted() = 0;
  /// To be called before the end if the last messages should arrive: they have a second for it.
  virtual void linger() = 0;
};

/// Longest message of a server: an Observation of 1 GiB (docs/protocol.md, D5) with its envelope. A
/// longer one closes the connection when its size is known [bytes].
inline constexpr std::size_t longest_message = (std::size_t{1} << 30) + (std::size_t{1} << 20);

/// @throws std::invalid_argument for an unusable endpoint or keys
std::unique_ptr<Transport> make_transport(const SessionOptions& options);

}  // namespace ziggurat
