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
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "network/endpoint.h"
#include "wire/messages.h"
#include "world/state.h"

namespace ziggurat::network {

struct Config {
  std::vector<std::string> endpoints;  ///< all at once; tcp port `*` or 0 = any free one
  bool insecure = false;               ///< allow addresses that are not loopback
  std::size_t max_message_bytes = std::size_t{64} << 20;  ///< of a client's message
  std::size_t max_sessions = 4096;
  unsigned max_faults = 100;  ///< bad messages in a row before a session is thrown out
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
  woken,      ///< a descriptor is readable, or a signal arrived; call again to go on
};

/// Who holds a robot, and whether the tick waits for it.
struct RobotStatus {
  enum class Membership {
    free,  ///< nobody holds it: the barrier waits until somebody does
    held,
    gone,  ///< left the barrier for good; its commands are zero
  };
  Membership membership = Membership::free;
  std::string holder;                                   ///< held: name and version of the client
  bool awaited = false;                                 ///< the tick waits for it
  std::chrono::steady_clock::time_point awaited_since;  ///< if awaited
  std::chrono::steady_clock::time_point last_message;   ///< of its holder, if held
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
  std::vector<std::string> notices;  ///< sentences on peers: lost, garbage, refused; in order of
                                     ///< arrival, the oldest dropped beyond 100
};

class Server {
 public:
  /// Listens at once. The run's layout and controllers must outlive the server; what the run says
  /// of the message size is replaced by the config's.
  /// @throws EndpointError, also if an address is taken
  Server(const Config& config, const wire::Run& run);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where it listens, wildcards resolved; same order as in the config.
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

  /// These robots (positions in Layout::robots) are gone: their process died, say. They leave the
  /// barrier for good and their commands become zero.
  void remove_robots(std::span<const std::size_t> robots);

  std::vector<RobotStatus> status() const;  ///< per robot of the layout
  Report take_report();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::network
