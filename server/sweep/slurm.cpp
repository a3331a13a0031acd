// SPDX-License-Identifier: MIT
#include "sweep/slurm.h"

#include <fmt/format.h>
#include <unistd.h>

#include <map>
#include <sstream>
#include <system_error>

#include "processes/child_process.h"
#include "text/numbers.h"
#include "text/quoting.h"
#include "text/shortened.h"

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

constexpr int patience_of_slurm_ms = 60'000;

struct Said {
  bool well = false;  ///< exit code 0
  std::string text;   ///< stdout and stderr
};
/// @param log  a file for what it prints. Nothing if the program is not there.
std::optional<Said> run_program(const std::vector<std::string>& arguments, const fs::path& log) {
  try {
    processes::ChildProcess program({arguments, {}, log.string()});
    processes::end_all({&program}, patience_of_slurm_ms, [] { return false; });
    Said said{program.ended_well(), std::string(text::trimmed(read_file(log)))};
    fs::remove(log);
    return said;
  } catch (const std::system_error& error) {
    std::error_code ignored;
    fs::remove(log, ignored);
    if (error.code() == std::errc::no_such_file_or_directory) return std::nullopt;
    throw;
  }
}

fs::path id_file(const Folder& folder) { return folder.of_cluster() / "slurm_job"; }

/// In a pattern of sbatch for the names of files, between double quotes.
std::string in_pattern(const std::string& path) {
  std::string text;
  for (const char c : path) {
    if (c == '%') text += '%';
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text;
}

/// `0-2,5`.
std::string to_ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += text.empty() ? "" : ",";
    text +=
        last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace

std::string slurm_script(const Folder& folder, const std::vector<std::size_t>& tasks,
                         const std::vector<std::string>& command, unsigned jobs,
                         const SlurmOptions& options) {
  std::string text = "#!/bin/sh\n";
  const auto option = [&](const std::string& line) {
    if (line.find_first_of("\r\n") !=
        line.npos) {  // what stands behind would be a command of the script
      throw text::UsageError(fmt::format(
          "'{}' has a line break, which no option of Slurm may have; choose another folder, or "
          "option",
          line));
    }
    text += "#SBATCH " + line + "\n";
  };
  option("--job-name=ziggurat-sweep");
  option("--array=" + to_ranges(tasks));
  option(fmt::format("--cpus-per-task={}", jobs));
  option("--requeue");
  option("--open-mode=append");
  option(fmt::format("--output=\"{}/task-%a.log\"", in_pattern(folder.of_cluster().string())));
  if (!options.partition.empty()) option("--partition=" + options.partition);
  for (const std::string& each : options.options) option(each);
  text +=
      "# A task that is submitted again, or requeued, goes on with the runs that it has not yet "
      "written down.\nexec";
  for (const std::string& word : command) text += " " + text::shell_word(word);
  return text + "\n";
}

void refuse_if_queued(const Folder& folder) {
  const auto queued = slurm_status(folder);
  if (!queued) return;
  throw text::UsageError(
      fmt::format("the tasks of {} are still queued ({}); wait for them, or end them "
                  "with scancel",
                  folder.path().string(), *queued));
}

std::string submit_to_slurm(const Folder& folder, const std::string& script) {
  const fs::path path = folder.of_cluster() / "job.sh";
  write_file(path, script);
  const auto said =
      run_program({"sbatch", "--parsable", path.string()}, folder.of_cluster() / "sbatch.log");
  if (!said) {
    throw text::UsageError(
        fmt::format("--slurm needs sbatch, which is not in the PATH; on Debian: "
                    "apt-get install slurm-client. The script is {}",
                    path.string()));
  }
  if (!said->well)
    throw text::UsageError(fmt::format("sbatch refused {}: {}", path.string(), said->text));
  // `7` or `7;cluster`, behind warnings.
  const std::string last = said->text.substr(said->text.rfind('\n') + 1);
  const std::string id = last.substr(0, last.find(';'));
  write_file(id_file(folder), id + "\n");
  return id;
}

std::optional<std::string> slurm_status(const Folder& folder) {
  const std::string id(text::trimmed(read_file(id_file(folder))));
  if (id.empty()) return std::nullopt;
  const auto said = run_program({"squeue", "--noheader", "--array", "--jobs", id, "--format", "%T"},
                                folder.of_cluster() / fmt::format("squeue.{}.log", ::getpid()));
  if (!said || !said->well || said->text.empty()) return std::nullopt;
  std::map<std::string, int> counts;
  std::istringstream lines(said->text);
  for (std::string state; lines >> state;) ++counts[state];
  std::string text;
  for (const auto& [state, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, state);
  }
  return fmt::format("Slurm job {}: {}", id, text);
}

}  // namespace ziggurat::sweep
