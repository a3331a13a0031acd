#pragma once
// Tells ZeroMQ who may connect: answers its requests (ZAP, RFC 27) from a list of public keys.

#include <span>
#include <string>
#include <thread>
#include <unordered_map>
#include <zmq.hpp>

#include "network/keys.h"

namespace ziggurat::network {

/// Must stand before a socket of the context is bound: without it ZeroMQ accepts every client. A
/// message of an accepted connection has the client's index in the list as its `User-Id`.
class Gatekeeper {
 public:
  Gatekeeper(zmq::context_t& context, std::span<const ClientKey> clients);
  /// Ends once the context is shut down.
  ~Gatekeeper();
  Gatekeeper(const Gatekeeper&) = delete;
  Gatekeeper& operator=(const Gatekeeper&) = delete;

 private:
  void serve();
  void answer();

  zmq::socket_t socket_;
  std::unordered_map<std::string, std::size_t> clients_;  // by the 32 bytes of their key
  std::thread thread_;
};

}  // namespace ziggurat::network
