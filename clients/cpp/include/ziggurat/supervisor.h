// SPDX-License-Identifier: MIT
#pragma once
// Supervision of a run: status, pause, reset, entities. The world never waits for a supervisor.

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ziggurat/entity.h"

namespace ziggurat {

struct SupervisorOptions {
  std::string endpoint;  ///< `ipc://…` or `tcp://host:port`
  // Keys, for a server with an encrypted endpoint (--curve-secret). Both or none.
  std::string server_key;    ///< the server's public key, Z85: 40 characters
  std::string curve_secret;  ///< path of a file with this client's secret key, Z85

  bool only_observes = false;       ///< may request status and states only
  std::string name = "supervisor";  ///< of this program, for the server's messages
  std::string version;              ///< of this program, for the server's messages
  std::chrono::milliseconds connect_timeout{10'000};  ///< wall time until the server's welcome
  /// Wall time to wait for an answer; none = forever, as pause() and step() wait for controllers.
  std::optional<std::chrono::milliseconds> answer_timeout;
  /// Called while waiting, at least every half second of wall time: true ends the wait with a
  /// ConnectionError. None = no interruption.
  std::function<bool()> is_interrupted;
};

/// Wall time of a repeated step, over the last 1000 times [s].
struct Latency {
  double p50 = 0, p99 = 0, max = 0;
};

/// A session of the server.
struct SessionStatus {
  std::string client;  ///< name and version
  std::string role;    ///< "controller", "director", "supervisor" or "observer"
  std::string state;   ///< "ready", "owing", "answered", "paused", "draining" or "lost"
  std::vector<std::string> robots;  ///< ids
  std::uint64_t tick = 0;           ///< of its last observation
  double waiting = 0;        ///< owing or lost: how long the world has waited for it [s, wall]
  double last_message = 0;   ///< time since its last message [s, wall]
  Latency latency;           ///< from observation to command
  std::uint64_t misses = 0;  ///< deadlines missed
  std::string policy;        ///< "wait", or an action with its deadline: "hold after 50 ms"
  std::string director;      ///< its id; empty: it is none
};

struct ServerStatus {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{};  ///< simulated
  std::string phase;                ///< "gathering", "running", "paused" or "ending"
  bool hardware_in_the_loop = false;
  std::uint64_t seed = 0;
  std::string scene, scene_hash;
  std::uint64_t last_tick = 0;  ///< 0: no last tick
  std::vector<SessionStatus> sessions;
  std::vector<std::string> free_robots;     ///< ids: without a session; the world waits for them
  std::vector<std::string> gone_robots;     ///< ids: they left the run forever
  std::vector<std::string> free_directors;  ///< ids: likewise without a session
  struct Phase {
    std::string name;  ///< "encode", "wait", "forces", "solve", … (docs/performance.md)
    Latency wall;
  };
  std::vector<Phase> budget;  ///< where the wall time of a tick goes
  double uptime = 0;          ///< [s, wall]
  /// Convergence of the contact solver since the world began; without islands: not known.
  struct Solver {
    std::uint64_t islands = 0;        ///< of bodies that touch, solved over all substeps
    std::uint64_t not_converged = 0;  ///< of them
    double worst_residual = 0;        ///< largest violation of the laws of contact [m/s] or [rad/s]
  } solver;
};

struct EntityState {
  struct Link {
    std::string id;
    std::array<double, 3> position{};               ///< of the link's frame in the world [m]
    std::array<double, 4> orientation{1, 0, 0, 0};  ///< quaternion w, x, y, z
    std::array<double, 3> velocity{};               ///< [m/s]
    std::array<double, 3> angular_velocity{};       ///< [rad/s]
  };
  std::string id;
  std::array<double, 3> position{};               ///< of the origin in the world [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< quaternion w, x, y, z
  std::vector<Link> links;
  std::vector<std::uint32_t> led_colors;  ///< 0xRRGGBB
};

struct WorldStates {
  std::uint64_t tick = 0;
  std::string hash;  ///< of the whole state, 16 hexadecimal digits
  std::vector<EntityState> entities;
};

/// A session without robots. Every call waits for the server's answer, which holds at the tick that
/// it names. A refused request is a ProtocolError. Not thread-safe.
class Supervisor {
 public:
  /// Connects and waits for the server's welcome.
  /// @throws ConnectionError, ProtocolError, std::invalid_argument for an unusable endpoint
  explicit Supervisor(const SupervisorOptions& options);
  /// Leaves.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  // All of them throw ConnectionError and ProtocolError. A returned tick is the one at which the
  // request took effect.

  ServerStatus status();
  /// Returns when the tick is complete and the world has stopped; the tick at which it stopped.
  std::uint64_t pause();
  std::uint64_t resume();
  /// Runs this many ticks of a paused world; returns when it has stopped again.
  std::uint64_t step(std::uint64_t ticks);
  /// Builds the world again; none = with the same seed.
  void reset(std::optional<std::uint64_t> seed = std::nullopt);
  /// Keeps the world under a name: 1 to 64 letters, digits, `-`, `_` and `.`.
  std::uint64_t snapshot(std::string_view name);
  /// Back to a snapshot; the tick that the world is at then. Refused while clients have robots that
  /// can't go back.
  std::uint64_t restore(std::string_view name);
  /// @param xml  one element, as in <arena>
  std::uint64_t spawn(std::string_view xml);
  std::uint64_t remove(std::string_view entity);
  /// The entity is at rest at the pose, its joints in their initial positions; no orientation = the
  /// present one. Where others are that is refused, unless it may overlap them: they are pushed
  /// apart.
  std::uint64_t move(std::string_view entity, const std::array<double, 3>& position,
                     const std::optional<std::array<double, 4>>& orientation = std::nullopt,
                     Onto onto = Onto::free_place);
  /// A revolute or prismatic joint is put to a position [m, rad] from the assembled pose, within
  /// its limits, and a velocity [m/s, rad/s]. What hangs on it follows; other joints and the root
  /// of the entity stay, and motors keep their targets.
  std::uint64_t set_joint(std::string_view entity, std::string_view joint, double position,
                          double velocity = 0);
  /// The overlap of an entity, or an element as in <arena>, at a pose of its origin: the first
  /// other entity's id, or nothing where the place is free. The floor does not count, nor does the
  /// entity itself.
  /// @param what  an id, or an element, which begins with '<': of a single body its extents are
  /// enough, as in
  ///              <box size="1,1,1"/>
  std::optional<std::string> overlapped(
      std::string_view what, const std::array<double, 3>& position,
      const std::optional<std::array<double, 4>>& orientation = std::nullopt);
  /// Whether that is nothing.
  bool is_free(std::string_view what, const std::array<double, 3>& position,
               const std::optional<std::array<double, 4>>& orientation = std::nullopt) {
    return !overlapped(what, position, orientation);
  }
  /// @param entities  ids or globs; none = all
  WorldStates read(std::span<const std::string> entities = {});
  /// Ends the run, as Ctrl-C does. With a reason that was planned: the run's exit code is 0.
  void shutdown(std::string_view reason = {});

  /// The last answer to status() or read() as protobuf's JSON, for programs.
  std::string last_answer_json() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat
