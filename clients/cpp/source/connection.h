// SPDX-License-Identifier: MIT
#pragma once
// The client's connection: it sends and receives messages of the protocol.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "transport.h"
#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

// Version of the protocol.
inline constexpr std::uint32_t version_major = 1;
inline constexpr std::uint32_t version_minor = 5;

class Connection {
 public:
  using Kind = v1::ServerMessage::MessageCase;

  /// Starts to connect; the server may start later.
  /// @throws std::invalid_argument for an unusable endpoint or keys
  explicit Connection(const SessionOptions& options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(const v1::ClientMessage& message);

  /// Whether it was closed, or silent for longer than the server promised: it is of no use any
  /// more.
  bool is_lost() const { return is_lost_; }
  /// Whether the server has accepted the connection: if it does not answer then, it is slow.
  bool is_accepted() { return transport_->is_accepted(); }
  /// @throws ConnectionError that it is lost, and why
  [[noreturn]] void lose(const std::string& why);
  /// Starts to connect again, beside the lost connection.
  void reconnect();
  /// A session has begun over this connection. A lost one before it is closed now: earlier, the
  /// server would take the session's robots for free.
  /// @param silence  wall time after which a connection without messages is lost; 0 = never
  void begin_session(std::chrono::milliseconds silence);

  /// Waits for a message; its kind, or none after the time-out. Kinds that this client does not
  /// know are MESSAGE_NOT_SET.
  /// @param timeout  wall time; none = forever
  /// @param is_interrupted  if given, called regularly: true ends the wait without a message
  /// @throws ConnectionError if the connection is lost, or the server sent invalid bytes
  std::optional<Kind> receive(std::optional<std::chrono::milliseconds> timeout,
                              const std::function<bool()>& is_interrupted);

  // The last message, valid until the next is received. Observations and states of the world are in
  // separate messages, which keep their memory.
  const v1::Observation& observation() const { return observation_; }
  const v1::WorldState& world_state() const { return world_state_; }
  const v1::ServerMessage& message() const { return message_; }

 private:
  Kind parse();
  void forget(std::size_t size);
  void check_alive(std::chrono::milliseconds waited);

  SessionOptions options_;  // where to connect
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<Transport> lost_transport_;  // until the session goes on
  bool is_lost_ = false;
  std::chrono::milliseconds longest_silence_{0};
  std::chrono::milliseconds silence_{0};  // waited without a message
  v1::Observation observation_;
  v1::WorldState world_state_;
  std::size_t parsed_ = 0;  // [bytes] since these two last released their memory
  v1::ServerMessage message_;
};

}  // namespace ziggurat
