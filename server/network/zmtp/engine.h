// SPDX-License-Identifier: MIT
#pragma once
// The server's end of one ZMTP 3 connection, without its socket: bytes that arrive in, frames of
// messages out. What a client says of itself beside its key, such as a routing id, has no effect.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "network/keys.h"
#include "network/zmtp/curve.h"
#include "zmtp/frame.h"

namespace ziggurat::network::zmtp {

using namespace ziggurat::zmtp;

/// Result of parsing the bytes at the front of the input.
struct Taken {
  enum class Step {
    incomplete,  ///< too few bytes yet
    passed,      ///< handshake, or a command: there is nothing to do
    frame,       ///< a frame of a message
    too_long,    ///< a frame with more than the limit: its bytes need not be kept
    failed,      ///< not ZMTP, or not allowed: the connection must be closed
  };
  Step step = Step::incomplete;
  /// Number of bytes that are consumed. Of an incomplete frame the number that it needs. Of a frame
  /// that is too long its whole length, which has not all arrived.
  std::size_t size = 0;
  bool has_more = false;              ///< frame, too_long: the message goes on
  std::span<std::uint8_t> content{};  ///< frame: points into the input
};

class Engine {
 public:
  /// @param keys  must outlive the engine; null: no encryption
  explicit Engine(const CurveKeys* keys);

  /// The first bytes that the client must be sent: first_of_greeting.
  std::string greeting() const;
  /// Looks at the front of what has arrived. A frame in a box is opened in place.
  /// @param limit  of a frame's content [bytes]
  /// @param reply  what the client must be sent is appended
  Taken take(std::span<std::uint8_t> input, std::size_t limit, std::string& reply);

  /// The handshake is over: messages can be sent.
  bool is_open() const { return stage_ == Stage::open; }
  /// Why the last step has failed, for people; empty if none has.
  const std::string& refusal() const { return refusal_; }
  /// Rights of the client. @pre is_open()
  Access access() const;

  /// Offset of the content in a frame that has `content` bytes of it.
  std::size_t content_at(std::size_t content) const;
  /// Completes a frame. @param frame  with its content in place
  void seal(std::span<std::uint8_t> frame, std::size_t content);

 private:
  enum class Stage { greeting, hello, ready, open };
  Taken take_greeting(Bytes input, std::string& reply);
  std::string take_handshake(Bytes body, std::string& reply);
  Taken take_traffic(const Header& header, std::span<std::uint8_t> body, std::size_t size,
                     std::string& reply);
  void take_command(Bytes body, std::string& reply);
  Taken fail(std::string why);

  Stage stage_ = Stage::greeting;
  const CurveKeys* keys_;
  std::optional<CurvePeer> curve_;
  std::string refusal_;
};

}  // namespace ziggurat::network::zmtp
