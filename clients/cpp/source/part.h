// SPDX-License-Identifier: MIT
#pragma once
// Part that a session plays: the robots of a controller, or the world of a director. Knows
// messages, but no connection of its own.

#include <cstdint>
#include <optional>
#include <vector>

#include "connection.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Time of the message that is to be answered.
struct Moment {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;            ///< simulated
  std::optional<std::uint64_t> epoch;  ///< none: the server sends none
};

class Part {
 public:
  Part() = default;
  virtual ~Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  /// Role, and what it wants.
  virtual void ask(v1::Hello& hello) const = 0;
  /// @throws std::runtime_error if something is described wrongly
  virtual void begin(const v1::Welcome& welcome) = 0;
  /// The same session over another connection: all that was handed out stays.
  /// @param failures  that come before the answer; those that have no meaning any more are removed
  /// @throws ProtocolError if the session is not what it was
  virtual void go_on(const v1::Welcome& welcome, std::vector<v1::Leave>& failures) = 0;

  /// Moment of the connection's last message, if that is one to answer.
  virtual std::optional<Moment> moment(Connection::Kind kind, const Connection& from) const = 0;
  /// Reads that message, which stays unchanged until the next is received.
  /// @throws std::runtime_error if it is not what was announced; nothing is read
  virtual void read(const Connection& from) = 0;
  /// Another message.
  virtual void hear(Connection::Kind, const v1::ServerMessage&) {}

  /// Messages to send before the answer: one for each robot that failed since the last call.
  virtual std::vector<v1::Leave> take_failures() { return {}; }
  /// The answer: what was set since the last one.
  virtual void write(v1::ClientMessage& answer, const Moment& moment) = 0;
  virtual void sent() {}    ///< after the answer was sent
  virtual void repeat() {}  ///< the server may have discarded the last answer
  /// Adds log lines and metrics since the last answer.
  virtual void write(v1::Leave& leave) = 0;

  virtual void warn(const v1::Error&) {}       ///< something that was asked for has no effect
  virtual void reset() = 0;                    ///< the world begins anew
  virtual void restore(const v1::Command&) {}  ///< after reset(): it has gone back to this
  /// These robots (positions) have left the run.
  virtual void remove(const google::protobuf::RepeatedField<std::uint32_t>&) {}
};

}  // namespace ziggurat
