// SPDX-License-Identifier: MIT
#pragma once
// Answers the requests of supervisors and observers between two ticks (docs/protocol.md, section
// 9).

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "network/server.h"
#include "supervision/callers.h"
#include "supervision/population.h"
#include "supervision/snapshots.h"
#include "supervision/tick_budget.h"
#include "supervision/world.h"

namespace ziggurat::supervision {

/// Time that a paced run has been paused: its schedule shifts by that.
class PauseTimer {
 public:
  using clock = std::chrono::steady_clock;
  void update(bool is_paused);
  clock::duration total() const;

 private:
  std::optional<clock::time_point> paused_since_;
  clock::duration earlier_{};
};

class Supervision {
 public:
  using clock = std::chrono::steady_clock;

  struct Settings {
    std::uint64_t last_tick = 0;  ///< 0: until stopped
    bool is_hardware_in_the_loop = false;
    std::string snapshot_folder;  ///< where snapshots are written to and read from; empty: nowhere
    std::string build;            ///< of this program
    std::function<void()> write_outputs =
        {};  ///< all of them, before somebody is told that the world is halted; may be empty
  };

  /// Everything but the settings must outlive this.
  /// @throws std::runtime_error if a folder of the settings is none
  Supervision(const Settings& settings, World& world, network::Server& server, Callers& callers,
              Population& population);

  /// Answers the requests that can be answered now; the others wait for their tick. Call it
  /// whenever the server wakes, never while physics runs.
  void serve();

  void gathered() { is_gathered_ = true; }  ///< every robot has its controller
  void published();                         ///< a tick was published
  /// Takes the wall time of a tick that has ended.
  void add(const timing::PhaseTimes& tick) { budget_.add(tick); }

  /// A supervisor asks for a reset or a restore: the caller calls restart() between two ticks.
  bool requests_restart() const { return resetting_.has_value(); }
  /// Puts the world back to its start or to a snapshot, and tells all of it.
  /// @return  false if that can't be; then the supervisor gets an error, and the world stays as it
  /// is
  bool restart();

  /// A supervisor ends the run. The reason is empty if the end was not planned.
  const std::optional<std::string>& requested_shutdown() const { return shutdown_; }
  clock::duration paused_for() const { return paused_.total(); }
  wire::Status status() const;

 private:
  bool is_halted() const;
  Reply handle(const network::Call& call);
  Reply pause(const network::Call& call);
  Reply resume(const network::Call& call);
  Reply step(const network::Call& call);
  void end_steps();
  Reply reset(const network::Call& call);
  Reply read(const network::Call& call);
  Reply move(const network::Call& call);
  Reply spawn(const network::Call& call);
  Reply remove(const network::Call& call);
  Reply snapshot(const network::Call& call);
  Reply restore(const network::Call& call);
  Reply fail(const network::Call& call, wire::Fault fault);
  Reply done(const network::Call& call);

  const Settings settings_;
  World& world_;
  network::Server& server_;
  Callers& callers_;
  Population& population_;
  std::vector<network::Call> waiting_;  ///< unanswered, in order of arrival
  std::optional<network::Call> stepping_, resetting_;
  Snapshots snapshots_;
  std::optional<FoundSnapshot> restoring_;  ///< with resetting_
  std::uint64_t steps_left_ = 0;
  /// A pause that names a session of its program which still owes an answer: it may be on its way.
  struct HeldUp {
    std::string peer;
    std::uint64_t id = 0;  ///< of the request
    std::chrono::steady_clock::time_point since;
    bool was_paused = false;
  };
  std::optional<HeldUp> held_up_;
  bool is_gathered_ = false;
  std::optional<std::string> shutdown_;  // the reason
  clock::time_point start_ = clock::now();
  PauseTimer paused_;
  TickBudget budget_;
};

}  // namespace ziggurat::supervision
