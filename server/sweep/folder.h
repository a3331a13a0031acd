// SPDX-License-Identifier: MIT
#pragma once
// The folder that a sweep writes to.
//
//   experiment.json      definition of the sweep (definition.h);
//   sweep.sqlite         results of runs on this machine (ledger.h);
//   results.csv          all results, a row per run;
//   runs/000017/         log.txt and summary.json of a run that runs or failed, run.mcap if
//   recorded; tasks/0003.sqlite    results of one task of a cluster; cluster/             files
//   submitted to the cluster.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep/definition.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

class Folder {
 public:
  explicit Folder(const std::string& path)
      : path_(std::filesystem::absolute(path).lexically_normal()) {}

  /// The sweep that the folder belongs to. @throws text::UsageError if it belongs to none
  Definition definition() const;
  /// Checks that the folder is this sweep's, or free for one; changes nothing.
  /// @throws text::UsageError if it is another's, or has other files
  void check(const Definition& definition) const;
  /// Makes it the folder of this sweep, if it is not. @throws text::UsageError as check()
  void begin(const Definition& definition) const;

  /// Runs of all ledgers, by number; a run of several ledgers once. @throws LedgerError
  std::vector<Result> results() const;
  /// Runs of the ledgers that a task knows: its own, and that of runs outside of tasks.
  std::vector<Result> results_for_task(std::size_t task) const;
  /// Writes results.csv. @throws std::system_error
  void write_csv(const Experiment& experiment, const std::vector<Result>& results) const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path ledger() const { return path_ / "sweep.sqlite"; }
  std::filesystem::path csv() const { return path_ / "results.csv"; }
  std::filesystem::path of_run(std::size_t run) const;
  std::filesystem::path log_of(std::size_t run) const { return of_run(run) / "log.txt"; }
  std::filesystem::path of_tasks() const { return path_ / "tasks"; }
  std::filesystem::path task_ledger(std::size_t task) const;
  std::filesystem::path of_cluster() const { return path_ / "cluster"; }

 private:
  std::filesystem::path path_;
};

/// Held by a program and by the processes that it starts: a sweep that continues another one which
/// was killed waits until that one's last run is gone.
class Lock {
 public:
  /// Creates the file and locks it. Waits a moment for another holder.
  /// @throws text::UsageError if it is held for longer
  explicit Lock(const std::filesystem::path& path);
  ~Lock();
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  /// Whether a program holds it.
  static bool is_held(const std::filesystem::path& path);

 private:
  int file_ = -1;
};

/// All bytes; none if it can't be read.
std::string read_file(const std::filesystem::path& path);
/// Writes the whole file or nothing: what was there stays until then.
/// @throws std::system_error
void write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace ziggurat::sweep
