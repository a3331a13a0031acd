#pragma once
// The lock-step barrier without sockets and clocks: messages of peers and the time in, messages to
// peers out. Who may say what and when is decided here, by the table in docs/protocol.md.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "network/allowance.h"
#include "network/selection.h"
#include "network/server.h"
#include "network/session.h"
#include "wire/inbox.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "world/state.h"

namespace ziggurat::network {

enum class Delivery {
  sent,
  unreachable,  ///< the peer's connection is gone
  congested,    ///< the peer does not read; the message was dropped
};

/// Sends a message to the peer with this routing id, without waiting.
using Send = std::function<Delivery(const std::string& peer, const wire::Outbox& message)>;

/// The text with control characters replaced, so that a line stays a line on any terminal.
std::string printable(std::string_view text);

class Barrier {
 public:
  /// What the run refers to must outlive the barrier.
  Barrier(const Config& config, const wire::Run& run, Send send, Clock::time_point now);
  Barrier(const Barrier&) = delete;
  Barrier& operator=(const Barrier&) = delete;

  /// Everything happens at the time that was last told.
  void tell_time(Clock::time_point now) { now_ = now; }
  /// Wall time goes on: deadlines pass and heartbeats are sent.
  void advance(Clock::time_point now);
  /// When advance() has something to do next.
  Clock::time_point due() const {
    return std::min({next_deadline_, next_heartbeat_, next_departure_, next_arrival_});
  }

  /// One message of a peer.
  /// @param commands  where values go while a tick is being collected; null otherwise
  /// @param roles     that its key allows
  void receive(const std::string& peer, std::string_view bytes, world::Commands* commands,
               const Roles& roles = all_roles);
  /// Messages that were held back, as far as their time has come. `commands` as above.
  void receive_due(world::Commands* commands);
  /// A message that is no message of the protocol: of several frames, say.
  void receive_malformed(const std::string& peer);

  /// @param tag_payloads  of the same tick, for each of Layout::tags
  void publish(const world::Observations& observations, std::span<const std::string> tag_payloads);
  void finish(const wire::End& end);
  void add_robots(std::span<const std::string> scripts, const world::Observations& observations,
                  std::span<const std::string> tag_payloads);
  void remove_robots(std::span<const std::size_t> robots, const std::string& why = {});
  /// No tick is complete from now on; once the one in hand would be, sessions are told.
  void pause();
  void resume();
  /// Zeroes the targets of robots that are gone, or whose deadline says so.
  void zero_missing(world::Commands& commands);

  /// The world goes back to its start: sessions are told, and the next observation is tick 0.
  void reset(std::uint64_t seed);

  std::vector<Call> take_calls();
  /// Somebody calls, or the world has come to stand, since calls were last taken.
  bool has_news() const { return has_stood_ || !calls_.empty(); }
  /// Whether whoever called is still there.
  bool can_hear(const Call& call) const;
  void answer(const Call& call, const std::function<void(wire::Outbox&)>& write);
  /// Adds sessions, and robots that nobody has.
  void fill(wire::Status& status) const;
  /// Per controller of the scene: from observation to command.
  const std::vector<Latencies>& latencies() const { return latencies_; }

  bool gathered() const { return free_ == 0; }  ///< every robot is held or gone
  /// The tick is over.
  bool complete() const { return is_answered() && !is_paused_ && !is_stopped_; }
  bool standing() const { return is_standing_; }  ///< paused, and the tick is answered
  bool drained() const;                           ///< nobody is left

  std::vector<RobotStatus> status() const;
  std::vector<std::uint64_t> missed_ticks() const { return missed_ticks_; }
  /// Per controller of the scene: messages lost on purpose.
  const std::vector<Lost>& lost_messages() const { return lost_; }
  Report take_report();

  struct Known {
    std::size_t sessions = 0;  ///< connected and lost
    std::size_t peers = 0;     ///< connections that were heard of
  };
  /// What is kept of peers, for tests: nothing that they do makes it grow for ever.
  Known known() const { return {sessions_.size(), peers_.size()}; }

 private:
  struct Seat {  // of a robot
    Session* holder = nullptr;
    Session* claimant = nullptr;  // lost; may take it up again
    bool gone = false;
    bool was_held = false;
    bool passed = false;  // free, and the tick goes on without it
    bool zeroed = false;  // its commands become zero at the end of the tick
    std::uint32_t misses_in_row = 0;
    scene::DeadlinePolicy deadline;
    Clock::time_point free_since;
  };
  struct Peer {  // a connection, as far as it has been heard of
    Session* session = nullptr;
    bool is_told = false;  // that it sends too much
    Allowance allowance;
  };

  // barrier.cpp
  wire::Encoding encoding_of(const std::string& peer) const;
  void say_malformed(const std::string& peer, Session* session, std::string_view why);
  Peer& find_peer(const std::string& peer);
  bool afford(const std::string& id, Peer& peer);
  void fail(const std::string& peer, Session* session, wire::Fault fault,
            std::optional<std::uint64_t> request = {});
  void say_leave(Session& session);
  void say_heartbeat(const std::string& peer);
  void take(Session& session, wire::Inbox::Kind kind, world::Commands* commands);
  Delivery send(const std::string& peer, wire::Outbox& message);
  Delivery deliver(Session& session, wire::Outbox& message);
  void note(std::string text);
  std::string robots_of(const Session& session) const;

  // barrier_delays.cpp
  void set_paths(Session& session);
  Fate fate_of(const Session& session, Direction direction, std::uint64_t tick);
  Delivery send_observation(Session& session);
  Delivery hold_back(Session& session, wire::Outbox& message, Clock::duration delay);
  bool is_held_back(Session& session, wire::Inbox::Kind kind, std::string_view bytes);
  void send_due();
  void stop_delays(Session& session);

  // barrier_seats.cpp
  void take_seat(std::size_t robot, Session& session);
  void free_seat(std::size_t robot, Session* claimant);
  void mark_gone(std::size_t robot);
  void settle(Session& session);
  void lose(Session& session, std::string_view why);
  void displace(Session& session, const std::string& by);
  void erase(Session& session);
  void say_removed(Session& session, std::size_t robot, const std::string& why);
  bool say_end(Session& session, std::string why);
  void forget(Session& session);
  void forget_robots();

  // barrier_command.cpp
  bool observe(Session& session);
  bool say_command(Session& session, world::Commands* commands);
  void add_latency(Session& session);
  std::optional<wire::Fault> check_tick(const Session& session) const;
  bool is_answered() const { return free_ == passed_ && owing_ == 0; }
  void stand();

  // barrier_hello.cpp
  void say_hello(const std::string& peer, const Roles& roles);
  std::optional<wire::Refusal> check_hello(const wire::Hello& hello, const Roles& roles) const;
  std::optional<wire::Refusal> check_deadline(const wire::Hello& hello,
                                              std::span<const std::size_t> robots) const;
  std::optional<wire::Refusal> check_seat(std::size_t robot, bool is_takeover);
  std::variant<Session*, wire::Refusal> take_robots(const wire::Hello& hello);
  std::variant<Session*, wire::Refusal> resume(const wire::Hello& hello);
  bool welcome(Session& session);
  bool is_reachable(Session& session);
  void refuse(const std::string& peer, const wire::Hello& hello, wire::Refusal refused);

  // barrier_supervision.cpp
  std::variant<Session*, wire::Refusal> take_none(const wire::Hello& hello);
  void say_request(Session& session);
  wire::SessionStatus status_of(const Session& session) const;

  // barrier_deadlines.cpp
  scene::DeadlinePolicy policy_of(std::size_t robot) const;
  void set_patience(Session& session);
  void check_deadlines();
  bool miss(Session& session);
  void miss(std::size_t robot);
  void count_miss(std::size_t robot);
  void drop(std::size_t robot);
  void stop_run(std::size_t robot);
  void send_heartbeats();

  Config config_;
  wire::Run run_;
  Send send_;
  Clock::time_point now_;
  wire::Inbox inbox_;
  wire::Outbox outbox_;                               // everything but observations
  wire::Encoding stranger_ = wire::Encoding::binary;  // of the last peer without session
  std::vector<std::unique_ptr<Session>> sessions_;
  std::unordered_map<std::string, Peer> peers_;      // looked up; walked only to forget some
  std::vector<Seat> seats_;                          // per robot of the layout
  std::size_t free_ = 0;                             // robots that nobody holds
  std::size_t passed_ = 0;                           // those of them that the tick does not await
  std::size_t owing_ = 0;                            // sessions that owe an answer
  std::optional<world::Observations> observations_;  // of the published tick
  std::vector<std::string> tag_payloads_;            // at the published tick
  bool is_finished_ = false;
  bool is_paused_ = false;
  bool is_standing_ = false;
  bool has_stood_ = false;   // news for whoever paused it
  bool is_stopped_ = false;  // by a deadline: the tick is never over
  Clock::time_point next_deadline_ = Clock::time_point::max();
  Clock::time_point next_heartbeat_;
  Clock::time_point next_departure_ = Clock::time_point::max();  // of what is held back
  Clock::time_point next_arrival_ = Clock::time_point::max();    // likewise
  std::uint64_t heartbeats_ = 0;
  std::vector<std::uint64_t> missed_ticks_;                // per controller of the scene
  std::vector<std::optional<std::uint64_t>> last_missed_;  // likewise
  std::vector<Lost> lost_;                                 // per controller of the scene
  std::vector<Call> calls_;                                // not taken yet
  std::vector<Latencies> latencies_;                       // per controller of the scene
  Report report_;
};

}  // namespace ziggurat::network
