// SPDX-License-Identifier: MIT
#pragma once
// Messages as they come from clients: bytes -> plain data or world.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wire/command_limits.h"
#include "wire/direction.h"
#include "wire/messages.h"
#include "wire/request.h"
#include "wire/roster.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// Holds one message at a time and keeps its memory from command to command.
class Inbox {
 public:
  enum class Kind {
    malformed,  ///< not a message of this protocol
    too_large,  ///< has more fields than its client may send
    hello,
    command,
    leave,
    heartbeat,
    request,
    direction,
  };

  Inbox();
  ~Inbox();

  /// In either form, see encoding_of(). A message with more than `most` fields is too large; with
  /// more than `most_fields` it is malformed, and so is one for which there is not enough memory.
  Kind parse(std::string_view bytes, std::size_t most = most_fields);
  /// Fault that makes the current message malformed, for users; may be empty.
  const std::string& complaint() const;

  // Content of the current message, if it is of that kind.
  Hello hello() const;
  Leave leave() const;
  std::uint64_t heartbeat() const;                     ///< its sequence
  std::uint64_t command_tick() const;                  ///< of a command or direction
  std::optional<std::uint64_t> command_epoch() const;  ///< likewise; none: it does not say
  std::uint64_t request_id() const;
  Request request() const;
  bool is_question() const;  ///< a Request that changes nothing
  bool is_answer() const;    ///< a command or direction

  /// Checks the current direction, or the leave of a director, without regard to the world or its
  /// tick.
  std::optional<Fault> check_direction() const;
  /// The checked direction; of a leave its last words.
  Direction direction() const;

  /// Checks the current command or leave, but not its tick.
  std::optional<Fault> check(const Roster& roster, const world::Layout& layout) const;
  /// The same for its metrics, which sessions of earlier versions do not have.
  std::optional<Fault> check_metrics(const Roster& roster) const;
  /// Writes the checked command's values; those of robots that left are skipped.
  void apply(const Roster& roster, world::Commands& commands) const;
  /// Appends the lines that the checked command or leave brings.
  void append_log(const Roster& roster, std::vector<LogLine>& lines) const;
  /// Its checked metrics.
  std::vector<Metric> metrics(const Roster& roster) const;

 private:
  struct Message;
  Kind decode(std::string_view bytes);
  std::unique_ptr<Message> message_;
};

}  // namespace ziggurat::wire
