// SPDX-License-Identifier: MIT
#pragma once
// Executes runs, several at a time, and writes down each that ends.

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "processes/signals.h"
#include "reports/console.h"
#include "sweep/job.h"
#include "sweep/ledger.h"

namespace ziggurat::sweep {

/// The runs that are still to be executed.
/// @param runs     those of a sweep or of a task, by number
/// @param known    results so far
/// @param retries  runs that failed are executed again
std::vector<std::size_t> runs_to_do(const std::vector<std::size_t>& runs,
                                    const std::vector<Result>& known, bool retries);

class Sweep {
 public:
  /// All must outlive this.
  Sweep(const Experiment& experiment, const Folder& folder, const Settings& settings,
        Ledger& ledger, reports::Console& console, processes::Signals& signals);

  struct Counts {
    std::size_t finished = 0, failed = 0;
    bool is_interrupted = false;  ///< by a signal: the runs that were running are lost
  };
  /// Executes these runs. A run that another program killed is started again, up to three times.
  /// @throws LedgerError, std::system_error; runs that are not written down are lost then
  Counts execute(const std::vector<std::size_t>& runs);

 private:
  using clock = std::chrono::steady_clock;

  void start_jobs();
  void collect(Job& job);
  void report_failure(const Result& result);
  void show_progress();
  std::string progress_text() const;
  void interrupt();

  const Experiment& experiment_;
  const Folder& folder_;
  const Settings& settings_;
  Ledger& ledger_;
  reports::Console& console_;
  processes::Signals& signals_;

  std::deque<std::size_t> waiting_;
  std::vector<std::unique_ptr<Job>> jobs_;
  std::map<std::size_t, int> kills_;  ///< by run
  Counts counts_;
  std::size_t total_ = 0;
  double wall_s_ = 0;  ///< of all runs that ended
  clock::time_point shown_at_ = clock::now();
};

}  // namespace ziggurat::sweep
