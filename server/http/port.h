// SPDX-License-Identifier: MIT
#pragma once
// Serves a few short texts over HTTP, on a thread of its own: one request per connection. Clients
// can be slow, many and rude: each has a time and a number of bytes, and of too many the oldest
// ends.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "http/address.h"
#include "http/answer.h"

namespace ziggurat::http {

struct PortOptions {
  bool any_host = false;     ///< clients may call it by any name; else see allows_host()
  std::size_t clients = 16;  ///< at a time; the oldest makes place
  std::chrono::milliseconds time{5000};  ///< of a client, for its request and the answer
};

class Port {
 public:
  /// Answer for a path. It is called on the port's thread.
  using Read = std::function<Answer(std::string_view path)>;

  /// @param option  of the program, for messages
  /// @throws std::runtime_error if it can't listen
  Port(std::string_view option, const Address& address, Read read, const PortOptions& options = {});
  /// At once, whatever clients do.
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  std::uint16_t number() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The bytes that such a port sends for those of a request.
std::string answer_at_port(std::string_view request, const std::string& host,
                           const Port::Read& read, const PortOptions& options = {});

}  // namespace ziggurat::http
