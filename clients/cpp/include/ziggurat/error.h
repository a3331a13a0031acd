// SPDX-License-Identifier: MIT
#pragma once
// Errors between a controller and the server. Besides, unknown ids are std::out_of_range and
// invalid values std::invalid_argument; their messages name what is allowed. Texts of a server are
// printable in all of them, and have 4096 bytes at most.

#include <cstdint>
#include <stdexcept>
#include <string>

namespace ziggurat {

/// No server answered, the connection was closed, or no message arrived within the time-outs of
/// Options. what() names the endpoint and the time-out.
class ConnectionError : public std::runtime_error {
 public:
  explicit ConnectionError(const std::string& message);
};

/// The server refused the session or one of its messages. what() is the server's message.
class ProtocolError : public std::runtime_error {
 public:
  /// As in docs/protocol.md: `code` is the name there, for example "ROBOT_TAKEN".
  struct Details {
    std::string code;
    bool retryable = false;  ///< a retry of the same message may succeed
    std::uint64_t tick = 0;  ///< of the server
    std::string robot;       ///< id, if the error concerns one
    std::string field;       ///< of the message, if the error concerns one
    std::string holder;      ///< ROBOT_TAKEN: name of the client that owns the robot
  };

  ProtocolError(const std::string& message, Details details);
  const Details& details() const noexcept { return details_; }

 private:
  Details details_;
};

}  // namespace ziggurat
