#pragma once
// The command line of `ziggurat sweep`: which experiment, and how it is run.

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

}  // namespace ziggurat::cli
