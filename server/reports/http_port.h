#pragma once
// Serves a few short texts over HTTP, on a thread of its own: GET without a body, one request per
// connection. Clients can be slow, many and rude: each has a time, a number of bytes, and its turn.

#include <chrono>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <thread>

#include "network/descriptor.h"
#include "network/listener.h"

namespace ziggurat::reports {

class HttpPort {
 public:
  struct Content {
    std::string type;  ///< for example "text/plain"; empty: there is nothing at that path
    std::string text;
  };
  /// What is at a path. It is called on the port's thread.
  using Read = std::function<Content(std::string_view path)>;

  /// @param host  that clients may call the port, beside its numbers and localhost; `*`: any.
  /// Another name
  ///              is refused: a web page could have it mean this machine.
  HttpPort(network::Listener listener, std::string host, Read read);
  /// At once, whatever clients do.
  ~HttpPort();
  HttpPort(const HttpPort&) = delete;
  HttpPort& operator=(const HttpPort&) = delete;

  /// "tcp://address:port"
  const std::string& endpoint() const { return listener_.endpoint(); }

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Client {
    network::Descriptor descriptor;
    Time end;             // of its time
    std::string request;  // as far as it has arrived
    std::string answer;   // the rest; empty: the request is not complete yet
  };
  void serve();
  void accept();
  bool receive(Client& client) const;
  bool send(Client& client) const;

  network::Listener listener_;
  std::string host_;
  Read read_;
  network::Descriptor wake_;
  std::list<Client> clients_;  // the oldest first
  std::thread thread_;
};

/// The answer to a request whose header is complete, or has become too long.
/// @param host  see HttpPort
std::string answer_to(std::string_view request, const std::string& host,
                      const HttpPort::Read& read);

}  // namespace ziggurat::reports
