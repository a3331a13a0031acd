// SPDX-License-Identifier: MIT
#pragma once
// A wait for controllers, with what is watched meanwhile: signals, supervisors, viewers.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/signals.h"
#include "reports/console.h"
#include "reports/metrics.h"
#include "reports/progress.h"
#include "reports/summary.h"
#include "run/awaited_notice.h"
#include "run/live_view.h"
#include "run/lost_controllers.h"
#include "run/peer_reports.h"
#include "supervision/supervision.h"
#include "supervision/world.h"
#include "world/metric.h"

namespace ziggurat::run {

class Watch {
 public:
  using clock = std::chrono::steady_clock;

  struct Settings {
    std::string metrics;             ///< host:port where the status is served; empty = not at all
    bool insecure = false;           ///< metrics: the host may be other than loopback
    bool fail_fast = false;          ///< the first failure or drop of a robot ends the run
    bool waits_for_clients = false;  ///< serve: a client that disconnected may connect again
    std::optional<std::uint64_t> ticks;  ///< of the whole run; none: until it is stopped
    std::vector<unsigned> restarts;  ///< per controller of the scene: how often a process that died
                                     ///< is started again at most; empty: never
  };

  /// Everything but the settings must outlive this.
  /// @param live_view  serves viewers meanwhile; may be null
  /// @param tell     takes the lines of controllers, too
  /// @throws text::UsageError or std::runtime_error if metrics cannot be served
  Watch(const Settings& settings, const supervision::World& world, network::Server& server,
        processes::Controllers& controllers, supervision::Supervision& supervision,
        processes::Signals& signals, reports::Console& console, LiveView* live_view, TellLine tell);

  // Each of the three waits for something and prints what controllers and peers report meanwhile.
  // Each returns nothing if it was completed, otherwise how the run ends.

  /// Until every robot has its controller.
  std::optional<reports::Ending> gather();
  /// Until every controller has answered `tick`.
  std::optional<reports::Ending> collect(world::Commands& commands, std::uint64_t tick);
  /// Metrics that were set at that tick.
  const std::vector<world::Metric>& measured() const { return measured_; }
  /// Until that moment, which may change. A client that connects meanwhile may answer the tick.
  std::optional<reports::Ending> sleep_until(const std::function<clock::time_point()>& moment,
                                             world::Commands& commands);
  /// Until the first viewer is there, so that it sees the beginning; for longest_wait_for_viewer at
  /// most.
  std::optional<reports::Ending> wait_for_viewer(world::Commands& commands);
  /// Shows the last state to viewers until an interruption, or until one of them ends it.
  void show_end();

  /// Ends the run: tells the controllers, prints their last lines, and waits until every process
  /// has ended. An interruption meanwhile kills the processes that still run.
  void end_run(const wire::End& end);

  /// The world was reset.
  void forget_spawned() {
    peers_.forget_spawned();
    if (dropped_.size() > PeerReports::most_kept) dropped_.resize(PeerReports::most_kept);
  }

  /// Reports of controllers and other peers.
  const PeerReports& reported() const { return peers_; }
  /// A sentence on each robot that a deadline took out of the run.
  const std::vector<std::string>& dropped() const { return dropped_; }
  /// The sentence on the controller that ended the run; empty if none did.
  const std::string& vanished() const { return vanished_; }

 private:
  using Step = std::function<network::Outcome(const network::Wait&)>;

  std::optional<reports::Ending> until(const Step& step);
  std::optional<reports::Ending> interruption();
  std::optional<reports::Ending> supervisor_request();
  std::optional<reports::Ending> lost_controller();
  void serve();
  void take_report();

  const supervision::World& world_;
  network::Server& server_;
  const network::ServerDirectors directors_;
  processes::Controllers& controllers_;
  supervision::Supervision& supervision_;
  processes::Signals& signals_;
  reports::Console& console_;
  LiveView* const live_view_;
  const std::vector<int> descriptors_;  ///< that end a wait: of signals, and of viewers
  const bool fails_fast_;
  const std::optional<std::uint64_t> last_tick_;
  std::optional<reports::MetricsPort> metrics_;
  PeerReports peers_;
  reports::Progress progress_;
  AwaitedNotice notice_;
  std::optional<LostControllers> lost_;  ///< none: a client that disconnected may connect again
  Moment now_;
  std::vector<world::Metric> measured_;
  std::string vanished_;
  std::optional<reports::Ending> stopped_;  ///< by a deadline or a failure
  std::vector<std::string> dropped_;
};

}  // namespace ziggurat::run
