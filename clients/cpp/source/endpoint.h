#pragma once
// Endpoint of a connection without encryption: a socket's path on this machine, or a port of a
// host.

#include <sys/socket.h>

#include <future>
#include <optional>
#include <string>

#include "ziggurat/session.h"

namespace ziggurat {

struct SocketAddress {
  sockaddr_storage bytes{};
  socklen_t size = 0;  // [bytes]; 0: there is none
};

/// Checks that a server can listen at it. It must be one of these forms, and its port a number.
/// @throws std::invalid_argument that says what an endpoint is
void check_endpoint(const std::string& endpoint);

/// Whether the host of an endpoint has a name without address. Asks for a second at most.
bool has_unknown_host(const std::string& endpoint);

class PlainEndpoint {
 public:
  /// None for what only libzmq connects to: with keys, and what is neither ipc:///path nor tcp://host:port.
  static std::optional<PlainEndpoint> of(const SessionOptions& options);

  /// As the options name it.
  const std::string& text() const { return text_; }
  bool is_path() const { return port_.empty(); }
  /// Its address now. A name of a host is looked up by a thread of its own: that can take a minute.
  std::future<SocketAddress> address() const;

 private:
  PlainEndpoint(std::string text, std::string host, std::string port);

  std::string text_;
  std::string host_;  // or the path
  std::string port_;  // empty: it is a path
};

}  // namespace ziggurat
