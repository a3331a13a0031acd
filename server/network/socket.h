#pragma once
// The server's end of all connections: a ROUTER bound to every endpoint, and one for the private
// endpoint, because a ROUTER protects all of its endpoints or none.

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "network/config.h"
#include "network/gatekeeper.h"
#include "network/link.h"
#include "wire/outbox.h"

namespace ziggurat::network {

class Socket {
 public:
  /// @throws EndpointError
  explicit Socket(const Config& config);
  ~Socket();

  /// Listens at the config's private endpoint, too, and names it first. @throws EndpointError
  void add_private(const Config& config);

  const std::vector<std::string>& endpoints() const { return endpoints_; }

  // Neither waits.
  Delivery send(const std::string& connection, const wire::Outbox& message);
  Delivery send(const std::string& connection, std::string_view bytes);

  /// A message that arrived, if any. Valid until the next call.
  bool receive(Received& received);

  enum class Ready { message, woken, timed_out };
  /// Waits for a message, a readable descriptor, a signal, or the end of the time.
  Ready poll(std::chrono::milliseconds timeout, std::span<const int> descriptors);

 private:
  void close();
  zmq::socket_t make_router(const Config& config);
  void bind(zmq::socket_t& router, const std::string& endpoint, bool allows_any);
  Delivery send_frame(const std::string& connection, zmq::message_t& frame);
  bool receive(char router, Received& received);
  Roles roles_of_sender();

  zmq::context_t context_;
  std::vector<ClientKey> clients_;
  std::optional<Gatekeeper> gatekeeper_;
  std::vector<zmq::socket_t> routers_;  // the first byte of a connection's id is its router's index
  std::size_t next_ = 0;                // router that is asked first, in turn
  std::vector<std::string> endpoints_;
  std::vector<std::string> files_;  // of ipc endpoints, to remove at the end
  zmq::message_t frame_;
  std::vector<zmq::pollitem_t> items_;
};

}  // namespace ziggurat::network
