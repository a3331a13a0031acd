#pragma once
// The client's end of the wire: one DEALER, messages in and out.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

class Connection {
 public:
  using Kind = v1::ServerMessage::MessageCase;

  /// Starts to connect; the server may come up later.
  /// @throws std::invalid_argument for an unusable endpoint or keys
  explicit Connection(const Options& options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  const std::string& endpoint() const { return endpoint_; }

  void send(const v1::ClientMessage& message);

  /// From now on a connection that closes is an error; before, it is tried again.
  void expect_open() { is_expected_open_ = true; }
  bool is_closed() const { return is_closed_; }

  /// Waits for a message: which one, or none when the time is over. Kinds that this client does
  /// not know are MESSAGE_NOT_SET.
  /// @param timeout  wall time; none = for ever
  /// @param is_interrupted  if given, asked now and then: true ends the wait with no message
  /// @throws ConnectionError if the server closed the connection, or sent what is no message
  std::optional<Kind> receive(std::optional<std::chrono::milliseconds> timeout,
                              const std::function<bool()>& is_interrupted);

  // What came last, valid until the next is received. Observations have a message of their own
  // that keeps its memory.
  const v1::Observation& observation() const { return observation_; }
  const v1::ServerMessage& message() const { return message_; }

 private:
  void set_keys(const Options& options);
  bool receive_frame(std::chrono::milliseconds timeout);
  bool was_closed();
  Kind parse();
  void forget(std::size_t size);

  std::string endpoint_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  zmq::socket_t monitor_;  // reports that the connection was closed
  std::chrono::milliseconds socket_timeout_{-1};
  bool is_expected_open_ = false;
  bool is_closed_ = false;
  zmq::message_t frame_;
  v1::Observation observation_;
  std::size_t parsed_ = 0;  // [bytes] of observations since observation_ last began anew
  v1::ServerMessage message_;
};

}  // namespace ziggurat
