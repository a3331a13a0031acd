// SPDX-License-Identifier: MIT
#pragma once
// The server: sockets and a clock for the barrier (barrier/barrier.h). Robots are held by sessions;
// a tick goes out to all of them and is over when each has answered. Knows nothing of simulation:
// the program that calls it moves the world.
//
//   Server server(config);                                     // listens
//   while (the world is being loaded) server.attend(wait);
//   server.open(run, config);                                  // the world is there
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
#include <type_traits>
#include <vector>

#include "network/config.h"
#include "network/delays.h"
#include "network/endpoint.h"
#include "network/report.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "wire/request.h"
#include "world/commands.h"
#include "world/devices.h"

namespace ziggurat::network {

/// Timeout of a wait, and descriptors that end it.
struct Wait {
  std::chrono::milliseconds timeout{-1};  ///< wall time; negative: forever
  std::span<const int> descriptors;       ///< return as soon as one of these is readable
};

enum class Outcome {
  complete,   ///< what was waited for is there
  timed_out,  ///< the time is over; call again to go on
  woken,      ///< a descriptor is readable, a signal arrived, or take_calls() has something or the
              ///< world was halted; call again to go on
};

/// Whether the world is paused; once it is asked for, the world is halted when the current tick is
/// answered.
enum class Pause { none, requested, halted };

class Server {
 public:
  /// Listens at once, while the world is still being loaded: a client that comes is told so.
  /// @throws EndpointError, also if an address is taken
  explicit Server(const Config& config);
  /// The same for a world that is there.
  Server(const Config& config, const wire::Run& run);
  /// Clients that still wait for the world are told that it will not come.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Addresses that it listens at, wildcards resolved: the private one first, then as in the
  /// config.
  const std::vector<std::string>& endpoints() const;

  /// Answers clients while the world is being loaded.
  /// @param progress  that they are told
  Outcome attend(const Progress& progress, const Wait& wait);
  /// The world is there. Clients that wait for it are answered in the first wait.
  /// @param run  its layout and controllers must outlive the server; its message size is replaced
  ///             by the config's
  /// @param config  of which the part counts that depends on the scene
  /// @throws EndpointError for the private endpoint
  void open(const wire::Run& run, const Config& config);

  /// Until every robot that is not gone is held.
  Outcome gather(const Wait& wait);

  /// Sends what robots sense to every session: its tick begins. All sessions must have answered
  /// the tick before. Nothing is copied: both must stay as they are until the next publish(),
  /// add_robots() or reset(), for sessions that begin meanwhile.
  /// @param tag_payloads  of the same tick, for each of Layout::tags
  /// @param truth  that directors are told, which must stay likewise; null: none
  void publish(const world::Observations& observations,
               const std::vector<std::string>& tag_payloads, const wire::Truth* truth = nullptr);
  template <class Seen, class Payloads>
  requires(!std::is_lvalue_reference_v<Seen> ||
           !std::is_lvalue_reference_v<Payloads>) void publish(Seen&& temporary,
                                                               Payloads&& or_this_one) = delete;

  /// Until every robot that is not gone has answered the published tick; values are written into
  /// `commands` as they arrive, those of robots that are gone become zero. On anything but
  /// `complete` some robots' values may be in already; calling again goes on.
  /// @param metrics  gets those that were set at the tick, if it is complete: in scene order,
  /// sorted by
  ///                 name for each robot; null: not wanted
  Outcome collect(world::Commands& commands, const Wait& wait,
                  std::vector<world::Metric>* metrics = nullptr);

  /// Tells every session that the run is over. No ticks afterwards.
  void finish(const wire::End& end);

  /// Until every session that was told the end has left (their last log lines arrive here).
  /// Peers may never do so: give it a time and stop.
  Outcome drain(const Wait& wait);

  /// Waits for nothing but the time: messages that arrive meanwhile are taken, also commands of
  /// sessions that begin although the tick was complete.
  Outcome linger(world::Commands& commands, const Wait& wait);

  /// Robots have come: those of the layout that the server does not know yet. The current tick does
  /// not wait for them, the next one does.
  /// @param scripts  of them, as Run::scripts
  /// @param observations, tag_payloads  of the current tick, theirs included
  void add_robots(std::span<const std::string> scripts, const world::Observations& observations,
                  const std::vector<std::string>& tag_payloads);

  /// These robots (positions in Layout::robots) are gone, because their process died, for example.
  /// They leave the barrier for good and their commands become zero.
  /// @param why  a sentence for their sessions, which end with their last robot; empty: they are
  ///             not told
  void remove_robots(std::span<const std::size_t> robots, const std::string& why = {});

  /// While that holds no tick is complete: collect() must still be called. Once the tick is
  /// answered, the world is halted, and sessions are told.
  void set_paused(bool is_paused);
  Pause pause() const;

  /// The world went back to its start or to a snapshot: sessions are told, what they owed is void,
  /// and the next observation to be published is that of tick 0 or of the snapshot. Robots that the
  /// layout has no more, or that are others now, are forgotten, and sessions that have one of them
  /// are over; these others come by add_robots().
  /// @param restart  its epoch is the server's to know
  void restart(const wire::Restart& restart);

  /// Requests that arrived since the last call, in order of arrival.
  std::vector<Call> take_calls();
  /// Whether the client that called is still connected.
  bool can_hear(const Call& call) const;
  /// Every call is answered once; `write` puts the response into the outbox.
  void answer(const Call& call, const std::function<void(wire::Outbox&)>& write);
  /// The same for a call that changes nothing. If another one has asked the same while nothing has
  /// changed, it gets the same answer. The time that it takes counts as that of others than
  /// controllers.
  /// @param write  puts the response with number 0 into the outbox
  void answer_question(const Call& call, const std::function<void(wire::Outbox&)>& write);
  /// Adds what a server knows: sessions, and robots that are free or have left.
  void fill(wire::Status& status) const;
  std::vector<RobotStatus> status() const;  ///< per robot of the layout
  Performance performance() const;
  Report take_report();

 private:
  friend class ServerDirectors;
  friend void keep_alive(Server& server);
  friend Need need_of(const Server& server, const std::vector<std::string>& ids);
  struct State;
  std::unique_ptr<State> state_;
};

/// While the world is put back, when its layout may be another already: sends heartbeats as usual,
/// and takes no message.
void keep_alive(Server& server);

/// Greatest need of the sessions that have these robots or directors.
Need need_of(const Server& server, const std::vector<std::string>& ids);

/// The directors of a server.
class ServerDirectors {
 public:
  /// @param server  must outlive this
  explicit ServerDirectors(Server& server) : state_(*server.state_) {}

  /// Told of each Direction that arrives, before it is taken: what is wrong with it in the present
  /// world.
  void check_by(std::function<std::optional<wire::Fault>(const wire::Direction&)> check);
  /// Directions to apply between the published tick, which is complete, and the next. They are in
  /// the order of their directors' ids, and valid until the server waits again.
  const std::vector<Directed>& directions() const;
  bool wants_contacts() const;            ///< a director subscribed to them
  bool has(const std::string& id) const;  ///< a director of that id is there, or was
  /// Tells a director, if it is connected, that one of its acts was not done.
  void warn(const std::string& director, wire::Fault fault);
  std::vector<DirectorStatus> status() const;

 private:
  Server::State& state_;
};

}  // namespace ziggurat::network
