// SPDX-License-Identifier: MIT
#pragma once
// `ziggurat sweep`: its command line (which experiment, and how it is run), and its further
// commands.

#include <boost/program_options/options_description.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "scene/problem.h"
#include "sweep/definition.h"
#include "sweep/job.h"
#include "sweep/kubernetes.h"
#include "sweep/slurm.h"

namespace ziggurat::cli {

struct SweepOptions {
  sweep::Definition definition;
  std::string out;  ///< folder
  sweep::Settings settings;
  bool for_slurm = false;
  sweep::SlurmOptions slurm;
  std::string kubernetes_file;  ///< path of the manifest to write; empty: none
  sweep::KubernetesOptions kubernetes;
  std::optional<std::size_t> chunk;  ///< runs of a task of a cluster
  bool retries_failed = false;
  bool dry_run = false;
  bool quiet = false;
  std::vector<scene::Problem> warnings = {};  ///< of the scene
};

boost::program_options::options_description sweep_options();

/// A sweep of a scene or an experiment file. Reads the scene.
/// @throws text::UsageError, scene::SceneError
SweepOptions parse_sweep(const Arguments& arguments);

/// `resume OUT`: the experiment of the folder.
/// @throws text::UsageError, scene::SceneError if the scene can't be read any more or has changed
SweepOptions parse_resume(const Arguments& arguments);

/// `task OUT`: the same for one task of a cluster.
struct TaskOptions {
  SweepOptions sweep;
  std::optional<std::size_t> task;  ///< none: as the environment says
};
TaskOptions parse_task(const Arguments& arguments);

/// Submits the runs that have no result yet to a cluster. @returns an exit code
int submit_sweep(const SweepOptions& options);

/// `ziggurat sweep task DIR`: the runs of one task that have no result yet.
/// @returns an exit code: 0 also if runs failed, because that is a result
int sweep_task(const Arguments& arguments, processes::Signals& signals);

/// `ziggurat sweep status`, `results` and `plot`, of a folder of results. Each gets the arguments
/// behind its own name. @returns an exit code
int sweep_status(const Arguments& arguments);
int sweep_results(const Arguments& arguments);
int sweep_plot(const Arguments& arguments);

}  // namespace ziggurat::cli
