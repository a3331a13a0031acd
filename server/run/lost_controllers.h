// SPDX-License-Identifier: MIT
#pragma once
// Controllers that are lost while a run waits for them: processes that ended, connections that
// broke. Each is settled: it left by itself, it is started again, or the run ends.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "reports/console.h"
#include "run/peer_reports.h"
#include "supervision/world.h"

namespace ziggurat::run {

/// A moment of a run.
struct Moment {
  std::uint64_t tick = 0;
  bool gathered = false;  ///< every robot and director was there
};

class LostControllers {
 public:
  using clock = std::chrono::steady_clock;

  struct Settings {
    std::vector<unsigned> restarts;  ///< per controller of the scene: how often a process that died
                                     ///< is started again at most; empty: never
    std::optional<std::uint64_t> last_tick;  ///< of the run; none: until it is stopped
  };

  /// All must outlive this.
  LostControllers(Settings settings, const supervision::World& world, network::Server& server,
                  processes::Controllers& controllers, reports::Console& console,
                  PeerReports& peers)
      : settings_(std::move(settings)),
        world_(world),
        server_(server),
        directors_(server),
        controllers_(controllers),
        console_(console),
        peers_(peers) {}

  /// One child process or more have ended.
  void child_ended() { child_ended_ = true; }
  /// Whether a controller seems to be lost, which the next moments decide.
  bool is_undecided() const { return missed_since_ || is_early_; }
  /// Whether a look may find something.
  bool may_be_some() const { return is_undecided() || child_ended_ || !restarted_.empty(); }

  /// Settles what has been lost.
  /// @returns the sentence on the controller without which the run ends
  std::optional<std::string> look(const Moment& moment);

 private:
  bool is_missed(const processes::ControllerProcess& process,
                 const std::vector<network::RobotStatus>& status,
                 const std::vector<std::string>& free_directors, bool gathered) const;
  std::optional<std::string> settle(processes::ControllerProcess& ended,
                                    const std::vector<network::RobotStatus>& status,
                                    const Moment& moment);
  bool restart(const processes::ControllerProcess& ended, const std::string& end);
  std::optional<std::string> disconnected(const std::vector<std::size_t>& robots,
                                          const std::vector<std::string>& directors,
                                          std::uint64_t tick, clock::time_point now);

  const Settings settings_;
  const supervision::World& world_;
  network::Server& server_;
  network::ServerDirectors directors_;
  processes::Controllers& controllers_;
  reports::Console& console_;
  PeerReports& peers_;
  std::vector<std::size_t> restarted_;  ///< robots whose process was started again and is still to
                                        ///< connect
  bool child_ended_ = false;            ///< one or more, since the last look
  bool is_early_ = false;               ///< a process has ended whose last messages may still come
  std::optional<clock::time_point> missed_since_;  ///< a connection seems to be lost since then
};

}  // namespace ziggurat::run
