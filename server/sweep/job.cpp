// SPDX-License-Identifier: MIT
#include "sweep/job.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <system_error>

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds stop_patience{3};  // between SIGTERM and SIGKILL
constexpr int interrupted = 130;  // exit code of a run that a signal ended in good order

/// Each `{run}` becomes the number of the run.
std::string with_number(std::string text, std::size_t run) {
  constexpr std::string_view mark = "{run}";
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;) {
    const std::string number = fmt::format("{}", run);
    text.replace(at, mark.size(), number);
    at += number.size();
  }
  return text;
}

processes::Program program_of(const Experiment& experiment, const Combination& combination,
                              const Settings& settings, const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directory(
      folder.parent_path());  // the sweep's own is not made anew if somebody moved it away
  fs::create_directory(folder);
  processes::Program program;
  program.arguments = run_command(experiment, combination, settings.program, folder,
                                  settings.record != Record::none);
  program.output = (folder / "log.txt").string();
  return program;
}

}  // namespace

std::vector<std::string> run_command(const Experiment& experiment, const Combination& combination,
                                     const std::string& program, const fs::path& folder,
                                     bool records) {
  std::vector<std::string> command = {program, "run", experiment.scene};
  command.insert(command.end(), {"--seed", fmt::format("{}", combination.seed)});
  for (std::size_t i = 0; i < experiment.axes.size(); ++i) {
    const Axis& axis = experiment.axes[i];
    command.push_back(axis.kind == Axis::Kind::parameter ? "--param" : "--set");
    command.push_back(fmt::format("{}={}", axis.name, combination.values[i]));
  }
  const auto& given = experiment.run_arguments;
  const auto is_threads = [](const std::string& word) { return word.starts_with("--threads"); };
  if (std::ranges::none_of(given, is_threads)) command.insert(command.end(), {"--threads", "1"});
  command.insert(command.end(), {"--summary", (folder / "summary.json").string()});
  if (records) command.insert(command.end(), {"--record", (folder / "run.mcap").string()});
  for (const std::string& argument : given) {
    command.push_back(with_number(argument, combination.run));
  }
  return command;
}

Job::Job(const Experiment& experiment, const Folder& folder, const Settings& settings,
         std::size_t run, const processes::Guardian* guardian)
    : settings_(settings),
      combination_(combination(experiment, run)),
      folder_(folder.of_run(run)),
      process_(program_of(experiment, combination_, settings, folder_), guardian) {}

bool Job::poll() {
  if (process_.ended()) return true;
  if (process_.poll()) {
    end_ = clock::now();
    return true;
  }
  const auto now = clock::now();
  if (stopped_at_) {
    if (now - *stopped_at_ > stop_patience) process_.signal(SIGKILL);
  } else if (settings_.timeout &&
             std::chrono::duration<double>(now - start_).count() > *settings_.timeout) {
    process_.signal(SIGTERM);
    stopped_at_ = now;
  }
  return false;
}

bool Job::was_killed() const {
  const int code = process_.exit_code();
  return !stopped_at_ && (code == interrupted || code == 128 + SIGKILL || code == 128 + SIGTERM);
}

Result Job::result() const {
  Result result;
  result.run = combination_.run;
  result.seed = combination_.seed;
  result.exit_code = process_.exit_code();
  const bool has_summary = read_summary((folder_ / "summary.json").string(), result);
  if (stopped_at_) {
    result.outcome = Outcome::timed_out;
  } else if (result.exit_code != 0 || !has_summary) {
    result.outcome = Outcome::failed;
  }
  result.wall_s = std::chrono::duration<double>(end_ - start_).count();
  result.version = settings_.version;
  return result;
}

void tidy(const Folder& folder, const Result& result, Record record) {
  if (result.outcome != Outcome::finished) return;
  const fs::path path = folder.of_run(result.run);
  std::error_code ignored;
  for (const char* name : {"log.txt", "summary.json"}) fs::remove(path / name, ignored);
  if (record != Record::all) fs::remove(path / "run.mcap", ignored);
  fs::remove(path, ignored);  // unless it has other files
}

}  // namespace ziggurat::sweep
