// SPDX-License-Identifier: MIT
#include "sweep/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "sweep/sweep.h"
#include "text/numbers.h"
#include "text/shortened.h"

namespace ziggurat::sweep {
namespace {

constexpr std::size_t usual_tasks = 100;

std::filesystem::path chunk_file(const Folder& folder) { return folder.of_cluster() / "chunk"; }

}  // namespace

std::size_t task_count(const Experiment& experiment, std::size_t chunk) {
  return (run_count(experiment) + chunk - 1) / chunk;
}

std::vector<std::size_t> runs_of_task(const Experiment& experiment, std::size_t chunk,
                                      std::size_t task) {
  std::vector<std::size_t> runs;
  const std::size_t end = std::min(run_count(experiment), (task + 1) * chunk);
  for (std::size_t run = task * chunk + 1; run <= end; ++run) runs.push_back(run);
  return runs;
}

std::vector<std::size_t> tasks_to_do(const Experiment& experiment, std::size_t chunk,
                                     const std::vector<Result>& known, bool retries) {
  const auto left = runs_to_do(runs_of_task(experiment, run_count(experiment), 0), known, retries);
  std::vector<std::size_t> tasks;
  for (const std::size_t run : left) {
    const std::size_t task = (run - 1) / chunk;
    if (tasks.empty() || tasks.back() != task) tasks.push_back(task);
  }
  return tasks;
}

std::size_t kept_chunk(const Folder& folder) {
  const std::string text(text::trimmed(read_file(chunk_file(folder))));
  if (text.empty()) {
    throw text::UsageError(
        fmt::format("no tasks were submitted from {}; write: ziggurat sweep … --slurm",
                    folder.path().string()));
  }
  const std::size_t chunk = text::to_integer(chunk_file(folder).string(), text);
  if (chunk == 0) throw text::UsageError(fmt::format("{} is 0", chunk_file(folder).string()));
  return chunk;
}

std::size_t fix_chunk(const Folder& folder, const Experiment& experiment,
                      std::optional<std::size_t> wanted) {
  if (!std::filesystem::exists(chunk_file(folder))) {
    const std::size_t runs = run_count(experiment);
    const std::size_t chunk = wanted.value_or((runs + usual_tasks - 1) / usual_tasks);
    std::filesystem::create_directories(folder.of_cluster());
    std::filesystem::create_directories(folder.of_tasks());
    write_file(chunk_file(folder), fmt::format("{}\n", chunk));
    return chunk;
  }
  const std::size_t kept = kept_chunk(folder);
  if (wanted && *wanted != kept) {
    throw text::UsageError(fmt::format(
        "--chunk is {}, and the tasks of {} have {} runs each; leave --chunk out, or write another "
        "folder with --out",
        *wanted, folder.path().string(), kept));
  }
  return kept;
}

std::vector<std::string> task_command(const Folder& folder, const Settings& settings,
                                      bool retries) {
  std::vector<std::string> command = {settings.program, "sweep", "task", folder.path().string()};
  command.insert(command.end(), {"--jobs", fmt::format("{}", settings.jobs)});
  if (settings.timeout) {
    command.insert(command.end(), {"--timeout", fmt::format("{}", *settings.timeout)});
  }
  if (settings.record != Record::none) {
    command.insert(command.end(), {"--record", settings.record == Record::all ? "all" : "failed"});
  }
  if (retries) command.emplace_back("--retry-failed");
  return command;
}

std::size_t task_of_environment() {
  for (const char* name : {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"}) {
    if (const char* value = std::getenv(name)) return text::to_integer(name, value);
  }
  throw text::UsageError(
      "which task is not known: neither SLURM_ARRAY_TASK_ID nor "
      "JOB_COMPLETION_INDEX is in the environment; write --task N");
}

}  // namespace ziggurat::sweep
