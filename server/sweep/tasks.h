// SPDX-License-Identifier: MIT
#pragma once
// A sweep in pieces for the machines of a cluster: each task executes some runs in a row and writes
// a ledger of its own, so that no two machines write the same file.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sweep/folder.h"
#include "sweep/job.h"

namespace ziggurat::sweep {

// Tasks are numbered from 0.
std::size_t task_count(const Experiment& experiment, std::size_t chunk);
/// @param chunk  runs of a task
std::vector<std::size_t> runs_of_task(const Experiment& experiment, std::size_t chunk,
                                      std::size_t task);
/// The tasks that have a run without result, or with `retries` one that failed.
std::vector<std::size_t> tasks_to_do(const Experiment& experiment, std::size_t chunk,
                                     const std::vector<Result>& known, bool retries);

/// Number of runs of a task, which is fixed when the first one is submitted: kept in the folder.
/// @param wanted  none: as kept, otherwise as many as make 100 tasks or fewer
/// @throws text::UsageError if another number is kept
std::size_t fix_chunk(const Folder& folder, const Experiment& experiment,
                      std::optional<std::size_t> wanted);
/// @throws text::UsageError if nothing was submitted from this folder
std::size_t kept_chunk(const Folder& folder);

/// The command that executes a task; which one, the cluster tells it by its environment.
/// @param settings  its program is the first word
std::vector<std::string> task_command(const Folder& folder, const Settings& settings, bool retries);

/// The number of the task that this process is: SLURM_ARRAY_TASK_ID, or JOB_COMPLETION_INDEX of
/// Kubernetes. @throws text::UsageError without these
std::size_t task_of_environment();

}  // namespace ziggurat::sweep
