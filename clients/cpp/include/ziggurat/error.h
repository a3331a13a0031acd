#pragma once
// What can go wrong between a controller and the server. Unknown robot and joint names are
// std::out_of_range, unusable values std::invalid_argument; both say what would have been right.

#include <cstdint>
#include <stdexcept>
#include <string>

namespace ziggurat {

/// No server answered, it went away, or it stayed silent for longer than Options allow. what()
/// says who was waited for, at which endpoint, and how long.
class ConnectionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The server refused the session or one of its messages. what() is the server's sentence.
class ProtocolError : public std::runtime_error {
 public:
  /// As in docs/protocol.md: `code` is the name there, for example "ROBOT_TAKEN".
  struct Details {
    std::string code;
    bool retryable = false;  ///< the same message may succeed later
    std::uint64_t tick = 0;  ///< that the server was at
    std::string robot;       ///< id, where one is concerned
    std::string field;       ///< of the message, where one is concerned
    std::string holder;      ///< ROBOT_TAKEN: name of the client that drives the robot
  };

  ProtocolError(const std::string& message, Details details)
      : std::runtime_error(message), details_(std::move(details)) {}
  const Details& details() const noexcept { return details_; }

 private:
  Details details_;
};

}  // namespace ziggurat
