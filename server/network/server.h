#pragma once
// The lock-step barrier: robots are held by sessions; a tick goes out to all of them and is over
// when each has answered. Knows nothing of simulation: whoever calls it moves the world.
//
//   Server server(config, run);
//   while (server.gather(wait) != Outcome::complete) …;        // until every robot is held
//   for each tick:
//     server.publish(observations, tag_payloads);
//     while (server.collect(commands, wait) != Outcome::complete) …;
//     … server.take_report() …
//   server.finish(end);
//   while (server.drain(wait) != Outcome::complete) …;         // bounded by the caller

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "network/allowance.h"
#include "network/delays.h"
#include "network/endpoint.h"
#include "network/keys.h"
#include "network/latencies.h"
#include "scene/deadline.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "wire/request.h"
#include "world/state.h"

namespace ziggurat::network {

class Reception;

struct Config {
  std::vector<std::string> endpoints;  ///< all at once; tcp port `*` or 0 = any free one
  /// One that only this user's processes can reach, without protection; empty: none.
  std::string private_endpoint;
  std::optional<Curve> curve;  ///< protects the endpoints, but not the private one
  bool insecure = false;       ///< without that: allow addresses that are not loopback
  std::size_t max_message_bytes = std::size_t{64} << 20;  ///< of a client's message
  std::size_t max_sessions = 4096;
  unsigned max_faults = 100;  ///< bad messages in a row before a session is thrown out
  Rate rate;                  ///< of a connection's messages, besides answers that were due
  std::chrono::milliseconds heartbeat{1000};  ///< of wall time that a session hears nothing; > 0
  std::chrono::milliseconds lease{0};         ///< that robots of a lost session are kept for it
  /// For when a controller does not answer in time.
  struct Deadline {
    scene::DeadlinePolicy policy;
    bool is_fixed = false;  ///< no Hello may wish for another
  };
  std::vector<Deadline> deadlines;    ///< per controller of the scene; missing: wait
  std::vector<Injection> injections;  ///< per controller of the scene; missing: none
  int io_threads = 1;
};

/// How long to wait, and for what else.
struct Wait {
  std::chrono::milliseconds timeout{-1};  ///< wall time; negative: for ever
  std::span<const int> descriptors;       ///< return as soon as one of these is readable
};

enum class Outcome {
  complete,   ///< what was waited for is there
  timed_out,  ///< the time is over; call again to go on
  woken,      ///< a descriptor is readable, a signal arrived or there is news for
              ///< supervisors; call again to go on
};

/// Who holds a robot, and whether the tick waits for it.
struct RobotStatus {
  enum class Membership {
    free,  ///< nobody holds it: the barrier waits until somebody does
    held,
    gone,  ///< left the barrier for good; its commands are zero
  };
  Membership membership = Membership::free;
  std::string holder;                                   ///< held: name and version of the client;
                                                        ///< free: of who may take it up again
  bool awaited = false;                                 ///< the tick waits for it
  std::chrono::steady_clock::time_point awaited_since;  ///< if awaited
  std::chrono::steady_clock::time_point last_message;   ///< of its holder, if held
  scene::DeadlinePolicy deadline;                       ///< for when it is not answered for
  bool was_held = false;                                ///< somebody has driven it
};

/// A robot whose controller reported its own failure.
struct Failure {
  std::size_t robot = 0;  ///< into Layout::robots
  std::string message;
  std::uint64_t tick = 0;  ///< of the observation that it failed on
};

/// What happened since the last report.
struct Report {
  std::vector<wire::LogLine> log;    ///< robots in scene order, then as given: never depends on
                                     ///< who runs where or who answers first
  std::vector<Failure> failures;     ///< in scene order
  std::string stopped;               ///< the sentence on the deadline that stops the run, if any
  std::vector<std::string> dropped;  ///< sentences on robots that a deadline took out: one for each
                                     ///< robot at most, so that no peer's noise can hide them
  std::vector<std::string> notices;  ///< sentences on peers: lost, garbage, refused; in order of
                                     ///< arrival, the oldest dropped beyond 100
};

/// A request of a supervisor or observer that waits for its answer.
struct Call {
  std::string peer;  ///< its connection
  wire::Request request;
};

class Server {
 public:
  /// Listens at once. The run's layout and controllers must outlive the server; what the run says
  /// of the message size is replaced by the config's.
  /// @throws EndpointError, also if an address is taken
  Server(const Config& config, const wire::Run& run);
  /// Goes on where a reception listens, which was made from the same config but for the private
  /// endpoint and the deadlines. Whoever waits there is answered in the
  /// first wait.
  Server(const Config& config, const wire::Run& run, Reception& reception);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where it listens, wildcards resolved: the private one first, then as in the config.
  const std::vector<std::string>& endpoints() const;

  /// Until every robot that is not gone is held.
  Outcome gather(const Wait& wait);

  /// Sends what robots sense to every session: its tick begins. All sessions must have answered
  /// the tick before.
  /// @param tag_payloads  of the same tick, for each of Layout::tags
  void publish(const world::Observations& observations, std::span<const std::string> tag_payloads);

  /// Until every robot that is not gone has answered the published tick; values are written into
  /// `commands` as they arrive, those of robots that are gone become zero. On anything but
  /// `complete` some robots' values may be in already; calling again goes on.
  Outcome collect(world::Commands& commands, const Wait& wait);

  /// Tells every session that the run is over. No ticks afterwards.
  void finish(const wire::End& end);

  /// Until every session that was told the end has left (their last log lines arrive here).
  /// Peers may never do so: give it a time and stop.
  Outcome drain(const Wait& wait);

  /// Nothing is waited for but the time: messages that arrive meanwhile are taken, also what those
  /// command who come to a tick that was complete.
  Outcome linger(world::Commands& commands, const Wait& wait);

  /// Robots have come: those of the layout that the server does not know yet. The tick in hand does
  /// not wait for them, the next one does.
  /// @param scripts  of them, as Run::scripts
  /// @param observations, tag_payloads  of the tick in hand, theirs included
  void add_robots(std::span<const std::string> scripts, const world::Observations& observations,
                  std::span<const std::string> tag_payloads);

  /// These robots (positions in Layout::robots) are gone: their process died, say. They leave the
  /// barrier for good and their commands become zero.
  /// @param why  a sentence for their sessions, which end with their last robot; empty: they are
  ///             not told
  void remove_robots(std::span<const std::size_t> robots, const std::string& why = {});

  /// The world stands still: collect() is not complete any more. Once the tick is answered,
  /// sessions are told, and `paused()` is true. Goes on being called meanwhile.
  void pause();
  void resume();
  bool paused() const;

  /// The world went back to its start: sessions are told, what they owed is void, and the next
  /// observation to be published is that of tick 0. Robots that the layout has no more are
  /// forgotten, and sessions that have one of them are over.
  void reset(std::uint64_t seed);

  /// Requests that arrived since the last call, in order of arrival.
  std::vector<Call> take_calls();
  /// Whether whoever called is still there.
  bool can_hear(const Call& call) const;
  /// Every call is answered once; `write` puts the response into the outbox.
  void answer(const Call& call, const std::function<void(wire::Outbox&)>& write);
  /// Adds what a server knows: sessions, and robots that nobody has.
  void fill(wire::Status& status) const;
  /// Per controller of the scene: wall time from observation to command.
  const std::vector<Latencies>& latencies() const;

  /// Per controller of the scene.
  const std::vector<Lost>& lost_messages() const;

  std::vector<RobotStatus> status() const;  ///< per robot of the layout
  /// Per controller of the scene: ticks at which one of its robots or more missed a deadline.
  std::vector<std::uint64_t> missed_ticks() const;
  Report take_report();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::network
