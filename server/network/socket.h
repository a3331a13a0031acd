#pragma once
// The server's end of all connections: a ROUTER bound to every endpoint, and one for the private
// endpoint, because a ROUTER protects all of its endpoints or none.

#include <optional>
#include <span>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "network/barrier.h"
#include "network/gatekeeper.h"
#include "network/server.h"

namespace ziggurat::network {

class Socket {
 public:
  /// @throws EndpointError
  explicit Socket(const Config& config);
  ~Socket();

  /// Listens at the config's private endpoint, too, and names it first. @throws EndpointError
  void add_private(const Config& config);

  const std::vector<std::string>& endpoints() const { return endpoints_; }

  Delivery send(const std::string& peer, const wire::Outbox& message);

  /// A message that arrived, if any. Valid until the next call.
  struct Received {
    std::string peer;
    std::string_view bytes;
    bool is_single_frame = true;
    Roles roles = all_roles;  ///< that the connection may have
  };
  bool receive(Received& received);

  /// Waits for a message, a readable descriptor, a signal, or the end of the time.
  enum class Ready { message, woken, timed_out };
  Ready poll(const Wait& wait);

 private:
  void close();
  zmq::socket_t make_router(const Config& config);
  void bind(zmq::socket_t& router, const std::string& endpoint, bool allows_any);
  bool receive(char router, Received& received);
  Roles roles_of_sender();

  zmq::context_t context_;
  std::vector<ClientKey> clients_;
  std::optional<Gatekeeper> gatekeeper_;
  std::vector<zmq::socket_t> routers_;  // the first byte of a peer's name is its router's index
  std::size_t next_ = 0;                // router that is asked first, by turns
  std::vector<std::string> endpoints_;
  zmq::message_t frame_;
  std::vector<zmq::pollitem_t> items_;
};

}  // namespace ziggurat::network
