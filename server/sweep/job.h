// SPDX-License-Identifier: MIT
#pragma once
// A run of a sweep as a process of its own: `ziggurat run` in its own process group, with a socket
// that no other run uses.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "processes/child_process.h"
#include "sweep/experiment.h"
#include "sweep/folder.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

/// Which runs keep a recording.
enum class Record { none, failed, all };

/// Settings of the execution of runs; they change no result.
struct Settings {
  std::string program;            ///< path of `ziggurat`
  std::string version;            ///< of it
  unsigned jobs = 1;              ///< runs at a time
  std::optional<double> timeout;  ///< wall time of a run [s]
  Record record = Record::none;
};

/// The command line of a run.
/// @param program  path of `ziggurat`
/// @param folder   that the run writes to
std::vector<std::string> run_command(const Experiment& experiment, const Combination& combination,
                                     const std::string& program,
                                     const std::filesystem::path& folder, bool records);

class Job {
 public:
  /// Empties the run's folder and starts it. All must outlive this. @throws std::system_error
  Job(const Experiment& experiment, const Folder& folder, const Settings& settings, std::size_t run,
      const processes::Guardian* guardian);

  std::size_t run() const { return combination_.run; }
  /// Whether the process has ended; never waits. Stops it if it takes too long.
  bool poll();
  /// Another program ended it: its result is not one of the scene.
  bool was_killed() const;
  /// Once it has ended.
  Result result() const;
  processes::ChildProcess& process() { return process_; }

 private:
  using clock = std::chrono::steady_clock;

  const Settings& settings_;
  Combination combination_;
  std::filesystem::path folder_;
  clock::time_point start_ =
      clock::now();  ///< before the process begins: this one may have to wait behind it
  processes::ChildProcess process_;
  clock::time_point end_;
  std::optional<clock::time_point> stopped_at_;  ///< because it took too long
};

/// Removes the sweep's files of a run that finished, apart from a recording that was asked for, and
/// its folder if it has nothing else.
void tidy(const Folder& folder, const Result& result, Record record);

}  // namespace ziggurat::sweep
