// SPDX-License-Identifier: MIT
#pragma once
// Replay of a recording, for `ziggurat replay` and `ziggurat verify`.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "processes/signals.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "reports/console.h"
#include "reports/progress.h"
#include "reports/summary.h"
#include "rerun/viewer_controls.h"
#include "run/live_view.h"
#include "run/options.h"
#include "run/recorders.h"
#include "run/schedule.h"
#include "supervision/world.h"
#include "timing/stopwatch.h"

namespace ziggurat::rerun {

struct ReplayOptions {
  std::string recording;               ///< path
  run::Options run;                    ///< outputs, view, pacing
  std::optional<std::uint64_t> until;  ///< the last tick; of the last epoch that has it
  bool verifies = false;               ///< the verdict is the result, on stdout
  bool from_poses = false;             ///< nothing is simulated: the recorded poses are shown
};

class ReplayRun {
 public:
  /// Reads the recording, builds its world and creates the output files.
  /// @throws replay::RecordingError and what main() turns into a message
  ReplayRun(const ReplayOptions& options, processes::Signals& signals);

  /// @returns an exit code: finished, differs, damaged or interrupted
  int execute();

 private:
  using clock = std::chrono::steady_clock;
  enum class End { complete, differs, damaged, stopped };

  void show_poses();
  run::LiveView::Run shown();
  End repeat();
  bool wait();
  bool may_step(clock::time_point now, int& timeout_ms);
  std::vector<world::Metric> take_metrics();
  void serve();
  void show_end();
  void tell(End end);
  wire::Status status() const;
  void complete_summary(End end);

  const ReplayOptions& options_;
  processes::Signals& signals_;
  reports::Console console_;
  const replay::RecordingFile file_;
  supervision::World world_;
  run::Recorders recorders_;
  replay::States states_;
  replay::Replay replay_;
  run::Schedule schedule_;
  ViewerControls viewer_controls_;
  const std::unique_ptr<run::LiveView> live_view_;  ///< null: not shown
  reports::Progress progress_;
  reports::Summary summary_;
  timing::Stopwatch watch_;
  std::uint64_t same_ = 0;  ///< states that are as recorded
  std::string difference_;  ///< what differs first
  std::string damage_;      ///< what ends the recording early
  bool is_empty_ = false;   ///< it is whole, without any state
  clock::time_point waits_for_viewer_until_{};
};

}  // namespace ziggurat::rerun
