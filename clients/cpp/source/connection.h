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

// Of the protocol.
inline constexpr std::uint32_t version_major = 1;
inline constexpr std::uint32_t version_minor = 1;

class Connection {
 public:
  using Kind = v1::ServerMessage::MessageCase;

  /// Starts to connect; the server may start later.
  /// @throws std::invalid_argument for an unusable endpoint or keys
  explicit Connection(const Options& options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  const std::string& endpoint() const { return endpoint_; }

  void send(const v1::ClientMessage& message);

  /// From now on a closed connection is an error; before, it is tried again.
  void expect_open();
  bool is_closed() const { return is_closed_; }

  /// Waits for a message; its kind, or none after the time-out. Kinds that this client does not
  /// know are MESSAGE_NOT_SET.
  /// @param timeout  wall time; none = forever
  /// @param is_interrupted  if given, called regularly: true ends the wait without a message
  /// @throws ConnectionError if the server closed the connection or sent invalid bytes
  std::optional<Kind> receive(std::optional<std::chrono::milliseconds> timeout,
                              const std::function<bool()>& is_interrupted);

  // The last message, valid until the next is received. Observations are in a separate message,
  // which keeps its memory.
  const v1::Observation& observation() const { return observation_; }
  const v1::ServerMessage& message() const { return message_; }

 private:
  Kind parse();
  void forget(std::size_t size);

  std::string endpoint_;
  std::unique_ptr<Transport> transport_;
  bool is_expected_open_ = false;
  bool is_closed_ = false;
  v1::Observation observation_;
  std::size_t parsed_ = 0;  // [bytes] since observation_ last released its memory
  v1::ServerMessage message_;
};

}  // namespace ziggurat
