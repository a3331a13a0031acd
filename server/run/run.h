// SPDX-License-Identifier: MIT
#pragma once
// A run from scene file to summary: what `ziggurat run`, `serve` and `render` share.

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/private_folder.h"
#include "processes/signals.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "run/live_view.h"
#include "run/local_endpoints.h"
#include "run/options.h"
#include "run/radio_watch.h"
#include "run/record.h"
#include "run/recorders.h"
#include "run/schedule.h"
#include "run/start_point.h"
#include "run/watch.h"
#include "supervision/directing.h"
#include "supervision/supervision.h"
#include "supervision/world.h"
#include "timing/stopwatch.h"

namespace ziggurat::run {

enum class Service {
  run,    ///< starts the scene's controllers
  serve,  ///< controllers connect from outside
};

/// Length of a run, and its speed.
struct Plan {
  std::optional<std::uint64_t> ticks;  ///< nothing = until stopped
  std::optional<double> real_time;     ///< simulated seconds per second of wall time, if paced
};

/// Statistics of a run, for its summary and its report card.
struct RunStatistics {
  reports::Summary summary;
  timing::Stopwatch watch;
  timing::PhaseTimes last_tick;  ///< wall time
  std::chrono::system_clock::time_point date =
      std::chrono::system_clock::now();         ///< of the beginning
  std::vector<reports::TickStart> tick_starts;  ///< of paced ticks
  std::uint32_t resets = 0;
};

/// Run of a world. Its members are in the order in which a run is set up.
class Run {
 public:
  /// Listens, builds the world, creates the output files and starts the controllers. All must
  /// outlive the run.
  /// @throws what main() turns into a message: faults of scene, options and environment
  Run(const Options& options, StartPoint& start, Service service, processes::Signals& signals);

  /// Runs the world to its end, tells the controllers and prints the summary.
  /// @returns an exit code
  /// @throws outputs::WriteError, reports::ConsoleError
  int execute();

 private:
  using Ending = reports::Ending;
  using Wait = std::function<std::optional<Ending>()>;

  // Setting up.
  std::unique_ptr<network::Server> listen() const;
  std::unique_ptr<supervision::World> load_world();
  Plan make_plan() const;
  network::Config complete_config();
  bool leaves_libraries() const;
  bool is_left_alone(const scene::Controller& controller) const;
  std::vector<std::size_t> robots_without_controller() const;
  processes::Controllers start_controllers();
  processes::LaunchSettings launch_settings() const;
  std::unique_ptr<RecordedRun> start_recording();
  supervision::Supervision::Settings supervision_settings();
  void print_notices();

  // Running.
  std::optional<Ending> reach_start();
  Ending run_to_end();
  Ending run_world();
  std::optional<Ending> collect();
  std::optional<Ending> pace();
  std::optional<Ending> wait(const Wait& step);
  bool reset_world();
  void end_tick();
  void print_troubles();

  // Ending.
  void end_in_failure(const std::exception& error);
  void complete_summary();
  bool report_hil();
  reports::ReportCard report_card() const;
  void print_summary();

  Options options_;  ///< with those of the scene, once it is read
  StartPoint& start_;
  const Service service_;
  processes::Signals& signals_;
  reports::Console console_;
  LocalEndpoints local_;
  network::Config config_;
  std::unique_ptr<network::Server> listening_;
  network::Server& server_;
  const std::unique_ptr<supervision::World> loaded_;
  supervision::World& world_;
  const Plan plan_;
  const bool with_controllers_;
  const processes::PrivateFolder folder_;
  const Programs programs_;
  Recorders recorders_;
  std::unique_ptr<RecordedRun> recorded_;  ///< null: not recorded, or not yet at the start point
  processes::Controllers controllers_;
  supervision::Callers callers_;
  supervision::Population population_;
  supervision::Supervision supervision_;
  supervision::Directing directing_;
  Schedule schedule_;
  const std::unique_ptr<LiveView> live_view_;  ///< null: not shown
  Watch watch_;
  RunStatistics statistics_;
  RadioWatch radio_watch_;
  struct {
    bool not_converged = false, slow = false;
  } printed_;  ///< notices, which are printed once
  bool waits_for_viewer_ = false;
};

}  // namespace ziggurat::run
