// SPDX-License-Identifier: MIT
#pragma once
// Report of peers and robots to the program that runs a server.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "network/delays.h"
#include "network/latencies.h"
#include "network/link.h"
#include "network/reactions.h"
#include "scene/deadline.h"
#include "wire/direction.h"
#include "wire/messages.h"
#include "wire/request.h"

namespace ziggurat::network {

/// Which session a robot has, and whether the tick waits for it.
struct RobotStatus {
  enum class Membership {
    free,  ///< without session: the barrier waits until one takes it
    held,  ///< by a session
    gone,  ///< left the barrier for good; its commands are zero
  };
  Membership membership = Membership::free;
  std::string holder;  ///< held: name and version of the client; free: of the lost session that
                       ///< may resume
  std::string
      token;  ///< of that session; a secret, for a process that is started in place of its own
  bool awaited = false;            ///< the tick waits for it
  Time awaited_since;              ///< if awaited
  Time last_message;               ///< of its session, if held
  scene::DeadlinePolicy deadline;  ///< what happens if it is not answered for in time
  bool was_held = false;           ///< a session has had it
  bool can_restore =
      true;  ///< held, or of a lost session: its controller can go back to a snapshot
};

/// Need of the world before it can pause or go on, if no deadline ends the wait.
enum class Need {
  nothing,
  answers,  ///< to each tick; the current one is answered
  answer,   ///< now: to the current tick
};

/// Whether a director is there, and whether the tick waits for it.
struct DirectorStatus {
  std::string id;
  bool is_held = false;     ///< a session has it
  bool has_left = false;    ///< the barrier, for good
  bool was_held = false;    ///< a session has had it
  bool waits = true;        ///< by its policy the world waits for it without end
  bool is_awaited = false;  ///< by the tick
  std::string client;       ///< name and version of the one that has it, or may resume it
  bool can_restore = true;  ///< that client can go back to a snapshot
};

/// Direction to apply between the current tick and the next. Not owned.
struct Directed {
  const std::string& director;  ///< id
  const wire::Direction& direction;
};

/// Response times and losses of controllers.
struct Performance {
  struct Controller {
    std::uint64_t missed_ticks = 0;  ///< at which one of its robots or more missed a deadline
    Lost lost;                       ///< messages lost on purpose
    AnswerTimes answer_times;        ///< from observations to commands
  };
  std::vector<Controller> controllers;  ///< of the scene
  const Reactions& reactions;           ///< of the server, if its config keeps them
};

/// Progress of loading the world.
struct Progress {
  double share = 0;  ///< 0 to 1
  std::string message;
};

/// A robot whose controller reported its own failure.
struct Failure {
  std::size_t robot = 0;  ///< into Layout::robots
  std::string message;
  std::uint64_t tick = 0;  ///< of the observation that it failed on
};

/// A robot whose controller took leave of it before the end of the run.
struct Departure {
  std::size_t robot = 0;   ///< into Layout::robots
  std::uint64_t tick = 0;  ///< of the last observation that it got
};

/// A director that reported its own failure.
struct DirectorFailure {
  std::string director;  ///< id
  std::string message;
  std::uint64_t tick = 0;
};

/// A line that a director logged.
struct DirectorLine {
  std::string director;  ///< id
  bool error = false;
  std::string text;
};

/// Events since the last report.
struct Report {
  std::vector<wire::LogLine> log;  ///< robots in scene order, then as given: independent of which
                                   ///< process runs where and which answers first
  std::vector<Failure> failures;   ///< in scene order
  std::vector<Departure> departures;           ///< in scene order
  std::vector<DirectorLine> log_of_directors;  ///< those of each as given
  std::vector<DirectorFailure> failed_directors;
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
  bool is_local = false;  ///< of this process, which answers it itself: no connection has sent it
  std::uint64_t session =
      0;  ///< its number, see SessionId; a connection may have several, one after the other
};

}  // namespace ziggurat::network
