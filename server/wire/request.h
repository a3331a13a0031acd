// SPDX-License-Identifier: MIT
#pragma once
// Requests of supervisors and observers, and the answers (docs/protocol.md, section 9).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wire/messages.h"
#include "world/metric.h"

namespace ziggurat::wire {

struct Request {
  enum class Kind {
    none,  ///< nothing was asked for
    status,
    pause,
    resume,
    step,
    reset,
    spawn,
    remove,
    move,
    read,
    shutdown,
    snapshot,
    restore,
    is_free,
    set_joint,
  };
  std::uint64_t id = 0;  ///< the client's own
  Kind kind = Kind::none;
  std::uint64_t ticks = 0;            ///< step
  std::optional<std::uint64_t> seed;  ///< reset
  /// spawn: XML; remove, move, set_joint: id of an entity; snapshot, restore: its name; shutdown:
  /// the reason, or nothing; is_free: one of the first two
  std::string text;
  bool is_element = false;            ///< is_free: the text is XML
  bool may_overlap = false;           ///< move: also onto others
  std::vector<std::string> entities;  ///< read: ids or globs
  std::vector<std::string>
      held_up;  ///< ids of robots or directors whose sessions can't answer before the Response
  std::vector<double> position;     ///< move, is_free: as given; x, y, z [m] if it is right
  std::vector<double> orientation;  ///< move, is_free: as given; w, x, y, z or nothing
  std::string joint;                ///< set_joint: its id
  double joint_position = 0;        ///< set_joint: as given [m] or [rad]
  double joint_velocity = 0;        ///< set_joint: as given [m/s] or [rad/s]
};

/// Percentiles of wall time [s].
struct Latency {
  double p50 = 0, p99 = 0, max = 0;
};

struct SessionStatus {
  enum class State { unspecified, ready, owing, answered, paused, draining, lost };
  std::string client;  ///< name and version
  Role role = Role::controller;
  State state = State::ready;
  std::vector<std::string> robots;  ///< ids
  std::uint64_t tick = 0;           ///< of its last observation
  double wall_waiting_s = 0;        ///< owing or lost: for how long
  double wall_last_message_s = 0;   ///< since its last message
  Latency latency;                  ///< from observation to command
  std::uint64_t misses = 0;         ///< deadlines missed
  scene::DeadlinePolicy deadline;
  std::string director;  ///< its id
};

/// Convergence of the physics' solver since the world began.
struct SolverStatus {
  std::uint64_t islands = 0;        ///< of bodies that touch, solved over all substeps
  std::uint64_t not_converged = 0;  ///< of them
  double worst_residual = 0;        ///< violation of the laws of contacts and motors [m/s], [rad/s]
};

struct Status {
  enum class Phase { unspecified, gathering, running, paused, ending };
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  Phase phase = Phase::gathering;
  bool is_hardware_in_the_loop = false;
  std::uint64_t seed = 0;
  std::string scene, scene_hash;
  std::uint64_t last_tick = 0;  ///< 0: until it is stopped
  std::vector<SessionStatus> sessions;
  std::vector<std::string> free_robots;  ///< ids: the barrier waits for a session that takes them
  std::vector<std::string> gone_robots;  ///< ids
  std::vector<std::string> free_directors;  ///< ids: likewise without a session
  struct PhaseBudget {
    std::string phase;
    Latency wall;
  };
  std::vector<PhaseBudget> budget;
  double wall_uptime_s = 0;
  SolverStatus solver;
  std::vector<world::Metric> metrics;  ///< last values, in scene order
};

/// As protobuf's JSON, on one line.
std::string to_json(const Status& status);

}  // namespace ziggurat::wire
