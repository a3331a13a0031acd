// SPDX-License-Identifier: MIT
#pragma once
// A sweep as a job array of Slurm.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sweep/folder.h"

namespace ziggurat::sweep {

struct SlurmOptions {
  std::string partition;             ///< empty: the cluster's usual one
  std::vector<std::string> options;  ///< further ones of sbatch, as `--mem=2G`
};

/// The job script: what sbatch gets.
/// @param tasks    the elements of the array
/// @param command  of a task: program and arguments
/// @param jobs     runs at a time of a task, each with a processor
std::string slurm_script(const Folder& folder, const std::vector<std::size_t>& tasks,
                         const std::vector<std::string>& command, unsigned jobs,
                         const SlurmOptions& options);

/// @throws text::UsageError if a job of the folder is still queued: its tasks and other runs would
/// do the same
void refuse_if_queued(const Folder& folder);

/// Writes the script to the folder and submits it. @returns the job's id
/// @throws text::UsageError if sbatch fails
std::string submit_to_slurm(const Folder& folder, const std::string& script);

/// State of the folder's job from squeue, as `Slurm job 7: 3 RUNNING, 2 PENDING`. Nothing if there
/// is none, it is over, or squeue is not there.
std::optional<std::string> slurm_status(const Folder& folder);

}  // namespace ziggurat::sweep
