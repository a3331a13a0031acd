// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "cli/sweep_options.h"
#include "outputs/output_file.h"
#include "outputs/output_name.h"
#include "reports/console.h"
#include "sweep/folder.h"
#include "sweep/ledger.h"
#include "sweep/sweep.h"
#include "sweep/tasks.h"
#include "text/numbers.h"
#include "text/quoting.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

/// Checks that a path which containers read or write is in the folder that they mount.
void check_is_mounted(const std::string& mount, const fs::path& path) {
  const fs::path relative = path.lexically_relative(fs::path(mount).lexically_normal());
  if (!relative.empty() && *relative.begin() != "..") return;
  throw text::UsageError(fmt::format("{} is not below --mount {}, so that containers don't see it",
                                     path.string(), mount));
}

int write_manifest(const SweepOptions& options, const sweep::Folder& folder, std::size_t chunk,
                   reports::Console& console) {
  auto settings = options.settings;
  settings.program = "ziggurat";
  const std::size_t tasks = task_count(options.definition.experiment, chunk);
  const std::string manifest =
      kubernetes_manifest(tasks, task_command(folder, settings, options.retries_failed),
                          settings.jobs, options.kubernetes);
  if (options.kubernetes_file == "-") {
    outputs::OutputFile file("-");
    file.buffer().append(manifest);
    file.close();
  } else {
    sweep::write_file(options.kubernetes_file, manifest);
  }
  console.report(fmt::format("{0}: an indexed Job with {1} tasks; write: kubectl create -f {2}",
                             options.kubernetes_file, tasks,
                             text::shell_word(options.kubernetes_file)));
  return exit_code::finished;
}

int submit(const SweepOptions& options, const sweep::Folder& folder, std::size_t chunk,
           reports::Console& console) {
  const auto& experiment = options.definition.experiment;
  const auto tasks = tasks_to_do(experiment, chunk, folder.results(), options.retries_failed);
  if (tasks.empty()) {
    console.report(fmt::format("all {} runs are done already", run_count(experiment)));
    return exit_code::finished;
  }
  const auto command = task_command(folder, options.settings, options.retries_failed);
  const std::string script =
      slurm_script(folder, tasks, command, options.settings.jobs, options.slurm);
  const std::string id = submit_to_slurm(folder, script);
  console.report(fmt::format(
      "submitted job {} with {} tasks of at most {} runs; how far it is: ziggurat sweep status {}",
      id, tasks.size(), chunk, text::shell_word(options.out)));
  return exit_code::finished;
}

}  // namespace

int submit_sweep(const SweepOptions& options) {
  reports::Console console({options.quiet, false});
  const sweep::Folder folder(options.out);
  const bool for_kubernetes = !options.kubernetes_file.empty();
  if (for_kubernetes) {
    outputs::check_output({"--kubernetes", options.kubernetes_file, {".yaml", ".yml"}});
    check_is_mounted(options.kubernetes.mount, folder.path());
    check_is_mounted(options.kubernetes.mount, options.definition.experiment.scene);
  }
  folder.check(options.definition);
  fs::create_directories(folder.path());
  const sweep::Lock lock(folder.path() / "lock");
  folder.begin(options.definition);
  sweep::refuse_if_queued(folder);
  const std::size_t chunk = fix_chunk(folder, options.definition.experiment, options.chunk);
  return for_kubernetes ? write_manifest(options, folder, chunk, console)
                        : submit(options, folder, chunk, console);
}

int sweep_task(const Arguments& arguments, processes::Signals& signals) {
  const TaskOptions options = parse_task(arguments);
  const sweep::Folder folder(options.sweep.out);
  const auto& definition = options.sweep.definition;
  folder.begin(definition);
  const std::size_t chunk = kept_chunk(folder);
  const std::size_t task = options.task ? *options.task : sweep::task_of_environment();
  if (task >= task_count(definition.experiment, chunk)) {
    throw text::UsageError(fmt::format("there is no task {}; the last one is {}", task,
                                       task_count(definition.experiment, chunk) - 1));
  }
  const fs::path path = folder.task_ledger(task);
  const sweep::Lock lock(fs::path(path).replace_extension(".lock"));
  sweep::Ledger ledger(path.string());
  const auto left = runs_to_do(runs_of_task(definition.experiment, chunk, task),
                               folder.results_for_task(task), options.sweep.retries_failed);
  reports::Console console({options.sweep.quiet, false});
  sweep::Sweep sweep(definition.experiment, folder, options.sweep.settings, ledger, console,
                     signals);
  const auto counts = sweep.execute(left);
  console.report(fmt::format("task {}: {} runs finished, {} failed{}", task, counts.finished,
                             counts.failed, counts.is_interrupted ? ", then interrupted" : ""));
  const int code = counts.is_interrupted ? exit_code::interrupted : exit_code::finished;
  signals.completed(code);
  return code;
}

}  // namespace ziggurat::cli
