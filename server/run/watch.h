#pragma once
// Waiting for controllers with open eyes: signals, processes that end, whoever keeps us waiting.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/signals.h"
#include "reports/console.h"
#include "reports/metrics.h"
#include "reports/progress.h"
#include "reports/summary.h"
#include "scene/scene.h"
#include "supervision/supervision.h"
#include "world/layout.h"

namespace ziggurat::run {

/// What a watch looks at; all of it outlives the watch.
struct Watched {
  const scene::Scene& scene;
  const world::Layout& layout;
  network::Server& server;
  processes::Signals& signals;
  std::vector<processes::ControllerProcess>& processes;
  reports::Console& console;
  supervision::Supervision& supervision;
  reports::MetricsPort* metrics;  ///< may be null
  bool waits_for_ever;            ///< serve: whoever vanishes may come back
};

class Watch {
 public:
  using clock = std::chrono::steady_clock;

  /// @param tick_length  simulated [s]
  Watch(const Watched& watched, double tick_length);

  // Each waits for something, prints what controllers and peers have to say meanwhile, and
  // returns how the run ends if that happens first.

  /// Until every robot has its controller.
  std::optional<reports::Ending> gather();
  /// Until every controller has answered `tick`.
  std::optional<reports::Ending> collect(world::Commands& commands, std::uint64_t tick);
  /// Until that moment. Who comes meanwhile may answer the tick.
  std::optional<reports::Ending> sleep_until(clock::time_point moment, world::Commands& commands);

  /// Ends the run: tells controllers, hears their last words, and sees every process end.
  /// An interruption meanwhile kills what still runs.
  void wind_down(const wire::End& end);

  /// Sorted by tick, then by scene order.
  std::vector<reports::Summary::Failure> failures() const;
  /// The sentence on the controller that ended the run; empty if none did.
  const std::string& vanished() const { return vanished_; }

 private:
  using Step = std::function<network::Outcome(const network::Wait&)>;

  std::optional<reports::Ending> until(const Step& step);
  std::optional<reports::Ending> interruption();
  std::optional<reports::Ending> wish();
  std::optional<reports::Ending> disappearance();
  void serve();
  void take_report();
  void print_log();
  std::vector<std::size_t> missing_robots() const;
  std::vector<std::size_t> awaited_robots() const;
  bool is_awaited(const processes::ControllerProcess& process) const;
  bool is_waited_for(const network::RobotStatus& robot) const;
  std::string by_controller(const std::vector<std::size_t>& robots) const;
  void say_who_is_awaited();
  void end_processes();

  Watched watched_;
  reports::Progress progress_;
  bool gathered_ = false;
  std::uint64_t tick_ = 0;
  std::vector<wire::LogLine> log_;  ///< of a tick that is not over
  std::vector<std::pair<std::size_t, reports::Summary::Failure>>
      failures_;  ///< with the robot's place
  std::string vanished_;
  bool is_stopped_ = false;                           ///< by a deadline
  std::optional<clock::time_point> suspected_since_;  ///< that a controller vanished
  clock::time_point waiting_since_{};
  std::string said_;      ///< who is awaited, as last printed
  int peer_notices_ = 0;  ///< printed so far
};

}  // namespace ziggurat::run
