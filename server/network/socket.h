// SPDX-License-Identifier: MIT
#pragma once
// Server's end of all connections: it listens at every endpoint and speaks ZMTP as a ROUTER does,
// but takes no routing ids from clients. It works in small steps: it accepts one connection, reads
// its bytes, or decodes some of its frames. Between two steps, messages of controllers and
// supervisors have priority. All others have the time in which no such message waits, and a small
// share of the rest.

#include <poll.h>
#include <time.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <ratio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "network/config.h"
#include "network/limits.h"
#include "network/link.h"
#include "network/listener.h"
#include "network/peer_table.h"
#include "network/token_bucket.h"
#include "wire/outbox.h"

namespace ziggurat::network {

/// The processor time of this thread: one that other programs keep from running uses none.
struct ThreadClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<ThreadClock>;
  static constexpr bool is_steady = true;
  static time_point now() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return time_point(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
  }
};

class Socket {
 public:
  /// @throws EndpointError
  explicit Socket(const Config& config);
  /// Sends what waits for clients that read, for a second at most.
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Listens at the config's private endpoint, too, and names it first. @throws EndpointError
  void add_private(const Config& config);

  const std::vector<std::string>& endpoints() const { return endpoints_; }
  /// Greatest number of connections within the system's limits.
  std::size_t most_connections() const { return most_peers_; }

  // Neither waits.
  Delivery send(const std::string& connection, const wire::Outbox& message);
  Delivery send(const std::string& connection, std::string_view bytes, MessageKind kind);

  /// Sets the standing of a connection.
  /// @param longest  length of its longest message [bytes]
  void set_standing(const std::string& connection, Standing standing, std::size_t longest);
  /// A message that arrived, if any. Valid until the next call. It is false, too, if clients send
  /// much that is no message: the caller looks at the time and calls again.
  bool receive(Received& received);
  /// Ends the work for the last message. Work for others is charged to their share: in full if a
  /// message of a controller or supervisor waits now.
  void handled();
  /// Connections that have ended since the last call.
  std::vector<std::string> take_gone() { return peers_.take_gone(); }

  /// Whether a tick waits for an answer of a controller: only then others are charged.
  void set_ticking(bool is_ticking) { is_ticking_ = is_ticking; }
  /// Disconnects those that have been without session for too long.
  void tend();

  enum class Ready { message, woken, timed_out };
  /// Waits for a message, a readable descriptor, a signal, or the end of the time.
  Ready poll(std::chrono::milliseconds timeout, std::span<const int> descriptors);

  /// Sentences for people since the last call.
  std::vector<std::string> take_notices(Time now) { return peers_.take_notices(now); }

 private:
  using Clock = std::chrono::steady_clock;

  /// An endpoint that listens.
  struct Entrance {
    Listener listener;
    std::uint64_t id = 0;  ///< in the list of what is ready
    Trust trust = Trust::none;
    bool is_accepting = true;

    /// Accepts connections, or leaves new ones waiting in the system.
    void set_accepting(ReadyList& list, bool accepts);
  };
  /// Connections that are served together.
  struct Group {
    ReadyList& list;
    std::deque<std::string> turns;  ///< those that may have messages: one each, in turn
    std::size_t until_look = 0;     ///< so many turns until the list is asked for others

    bool is_ready() const { return !turns.empty() || list.look(); }
    void give_turn(PeerSocket& peer);
  };

  void listen(const std::string& endpoint, Trust trust);
  Delivery send(const std::string& connection, std::size_t size, MessageKind kind,
                const auto& write);
  bool may_serve_others() const { return !is_ticking_ || Clock::now() >= others_wait_until_; }
  Group* next_group();
  bool look_at(Group& group, Received& received);
  bool take_message(Group& group, Received& received);
  void read_from(const ReadyList::Ready& ready);
  Group& group_of(const PeerSocket& peer);
  void accept(Entrance& entrance);

  const std::size_t longest_;  // message [bytes]
  const std::size_t most_peers_, most_without_session_;
  std::optional<zmtp::CurveKeys> keys_;
  std::vector<Entrance> entrances_;
  std::vector<std::string> endpoints_;
  PeerTable peers_;
  Group members_{peers_.members(), {}}, others_{peers_.others(), {}};
  Time next_tending_;

  bool is_ticking_ = false;
  const Rate share_;  // of the wall time, in seconds
  TokenBucket others_time_;
  Time others_wait_until_;
  std::optional<ThreadClock::time_point> other_since_;  // when what is done for one began
  int members_in_a_row_ = 0;                            // looks at them
  Buffer frame_;
  std::vector<pollfd> polled_;
};

}  // namespace ziggurat::network
