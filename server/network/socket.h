#pragma once
// The server's end of all connections: one ROUTER, bound to every endpoint.

#include <span>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "network/barrier.h"
#include "network/server.h"

namespace ziggurat::network {

class Socket {
 public:
  /// @throws EndpointError
  explicit Socket(const Config& config);

  const std::vector<std::string>& endpoints() const { return endpoints_; }

  Delivery send(const std::string& peer, const wire::Outbox& message);

  /// A message that arrived, if any. Valid until the next call.
  struct Received {
    std::string peer;
    std::string_view bytes;
    bool is_single_frame = true;
  };
  bool receive(Received& received);

  /// Waits for a message, a readable descriptor, a signal, or the end of the time.
  enum class Ready { message, woken, timed_out };
  Ready poll(const Wait& wait);

 private:
  void bind(const std::string& endpoint, const Config& config);

  zmq::context_t context_;
  zmq::socket_t router_;
  std::vector<std::string> endpoints_;
  zmq::message_t frame_;
  std::vector<zmq::pollitem_t> items_;
};

}  // namespace ziggurat::network
