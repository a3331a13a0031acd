// SPDX-License-Identifier: MIT
#pragma once
// Messages on their way to a client: plain data or world -> bytes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "wire/answer.h"
#include "wire/messages.h"
#include "wire/request.h"
#include "wire/roster.h"
#include "wire/world_view.h"
#include "world/state.h"

namespace ziggurat::v1 {
class ServerMessage;
}

namespace ziggurat::wire {

/// A protobuf message has less than 2 GiB. Radios and cameras of many robots in one session could
/// exceed it.
inline constexpr std::size_t max_observation_bytes = std::size_t{1} << 30;

/// The same for a session in JSON, of the binary form: in JSON an observation has up to thirteen
/// times as many bytes (radio messages without content).
inline constexpr std::size_t max_json_observation_bytes = max_observation_bytes / 16;

/// Holds one message at a time and keeps its memory: filling it with observation after
/// observation allocates nothing once it has grown.
class Outbox {
 public:
  Outbox();
  ~Outbox();
  Outbox(Outbox&&) noexcept;
  Outbox& operator=(Outbox&&) noexcept;

  void welcome(const Run& run, const Roster& roster, const Welcome& session);
  void refusal(const Refusal& refusal);
  /// False if it would have more than `limit` bytes in binary form; then there is no message.
  /// @param tag_payloads  of the same tick, for each of Layout::tags
  /// @param epoch         of the tick; none: the session knows of no epochs
  bool observation(const Roster& roster, const world::Observations& observations,
                   std::span<const std::string> tag_payloads,
                   std::size_t limit = max_observation_bytes,
                   std::optional<std::uint64_t> epoch = {});
  /// Before a director's first state, and whenever what it is told of has changed. False if it
  /// would have more than `limit` bytes in binary form; then there is no message, and the view is
  /// of no use any more.
  friend bool world_layout(Outbox& outbox, const Run& run, const Truth& truth, WorldView& view,
                           std::size_t limit);
  /// False if it would have more than `limit` bytes in binary form; then there is no message.
  friend bool world_state(Outbox& outbox, const Truth& truth, const WorldView& view,
                          std::size_t limit, std::uint64_t epoch);
  void end(const End& end);
  void error(const Fault& fault);
  void heartbeat(std::uint64_t sequence);
  void restart(const Roster& roster, const Restart& restart);
  // A request was done at this tick, with its result.
  /// @param overlapped  is_free: id of the entity that is at the place, or empty
  void response(std::uint64_t request, std::uint64_t tick,
                const std::optional<std::string>& overlapped = {});
  void response(std::uint64_t request, const Status& status);
  /// @param entities  into Layout::entities, ascending;  @param hash  16 hexadecimal digits
  void response(std::uint64_t request, const world::Layout& layout, const world::State& state,
                std::span<const std::size_t> entities, std::string_view hash);
  /// @param answer  must stay until the message is sent
  void response(std::uint64_t request, Answer& answer);
  void loading(double progress, std::string_view message);
  void paused(std::uint64_t tick);
  /// @param by  name of the client that has the robots now
  void displaced(std::string_view by, std::string_view message);
  void spawned(const Spawned& robot);
  /// A request was not done, and why.
  void response(std::uint64_t request, const Fault& fault);

  /// Chooses the form for size() and write() of the current message; binary by default.
  void encode(Encoding encoding);

  const v1::ServerMessage& message() const;  ///< the current one
  bool is_observation() const;               ///< the current one is, or a WorldState
  std::size_t size() const;                  ///< of the current message [bytes]
  void write(std::uint8_t* to) const;        ///< writes size() bytes

 private:
  struct Message;
  void finish();
  std::unique_ptr<Message> message_;
};

}  // namespace ziggurat::wire
