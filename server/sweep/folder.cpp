// SPDX-License-Identifier: MIT
#include "sweep/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

#include "scene/files.h"
#include "sweep/columns.h"
#include "sweep/ledger.h"
#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds lock_patience{5};  // for the runs of a program that was killed

fs::path definition_file(const fs::path& folder) { return folder / "experiment.json"; }

[[noreturn]] void fail_at(const fs::path& path) {
  throw std::system_error(errno, std::generic_category(), path.string());
}

void write_all(int file, std::string_view text, const fs::path& path) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_at(path);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// By number, each run once. Files that are not there have none.
/// @param runs  how many the sweep has
std::vector<Result> read_ledgers(std::span<const fs::path> paths, std::size_t runs) {
  std::map<std::size_t, Result> by_run;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) continue;
    for (Result& result : Ledger(path.string()).read()) {
      if (result.run < 1 || result.run > runs) {
        throw LedgerError(
            fmt::format("{} has a run {}, and the sweep has {}: the file is damaged, or of another "
                        "sweep; move it away",
                        path.string(), static_cast<std::int64_t>(result.run), runs));
      }
      auto& known = by_run[result.run];
      // A run that failed here and finished there counts as finished.
      if (known.run == 0 || known.outcome != Outcome::finished) known = std::move(result);
    }
  }
  std::vector<Result> results;
  for (auto& [run, result] : by_run) results.push_back(std::move(result));
  return results;
}

}  // namespace

std::string read_file(const fs::path& path) {
  const auto fault = scene::fault_of_file(path);
  if (fault && fs::exists(path)) throw text::UsageError(path.string() + " " + *fault);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const fs::path& path, const std::string& text) {
  fs::path draft = path;
  draft += fmt::format(".{}.new", ::getpid());
  ::unlink(draft.c_str());  // of a process that was killed
  const int file = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) fail_at(draft);
  try {
    write_all(file, text, draft);
    if (::fsync(file) != 0) fail_at(draft);
    if (::rename(draft.c_str(), path.c_str()) != 0) fail_at(path);
  } catch (...) {
    ::close(file);
    ::unlink(draft.c_str());
    throw;
  }
  ::close(file);
}

Definition Folder::definition() const {
  const fs::path path = definition_file(path_);
  if (!fs::exists(path)) {
    throw text::UsageError(
        fmt::format("{} is no folder of a sweep: it has no experiment.json; write "
                    "the folder of --out",
                    path_.string()));
  }
  return definition_from_json(read_file(path), path.string());
}

void Folder::check(const Definition& definition) const {
  if (fs::exists(definition_file(path_))) {
    return check_same(this->definition(), definition, path_.string());
  }
  if (!fs::exists(path_)) return;
  if (!fs::is_directory(path_)) {
    throw text::UsageError(
        fmt::format("{} is no folder; write an empty or a new one with --out", path_.string()));
  }
  const bool has_others = std::any_of(fs::directory_iterator(path_), {}, [](const auto& entry) {
    const std::string name = entry.path().filename();
    return name != "lock" && !name.starts_with("experiment.json.");
  });
  if (has_others) {
    throw text::UsageError(
        fmt::format("{} has files that are no sweep's; write an empty or a new "
                    "folder with --out",
                    path_.string()));
  }
}

void Folder::begin(const Definition& definition) const {
  check(definition);
  if (fs::exists(definition_file(path_))) return;
  fs::create_directories(path_);
  write_file(definition_file(path_), to_json(definition));
}

std::vector<Result> Folder::results() const {
  std::vector<fs::path> ledgers;
  if (fs::exists(of_tasks())) {
    for (const auto& entry : fs::directory_iterator(of_tasks())) {
      if (entry.path().extension() == ".sqlite") ledgers.push_back(entry.path());
    }
  }
  std::ranges::sort(ledgers);
  ledgers.push_back(ledger());
  return read_ledgers(ledgers, run_count(definition().experiment));
}

std::vector<Result> Folder::results_for_task(std::size_t task) const {
  const std::vector<fs::path> ledgers = {task_ledger(task), ledger()};
  return read_ledgers(ledgers, run_count(definition().experiment));
}

void Folder::write_csv(const Experiment& experiment, const std::vector<Result>& results) const {
  write_file(csv(), to_csv(experiment, results));
}

fs::path Folder::of_run(std::size_t run) const {
  return path_ / "runs" / fmt::format("{:06}", run);
}

fs::path Folder::task_ledger(std::size_t task) const {
  return of_tasks() / fmt::format("{:04}.sqlite", task);
}

Lock::Lock(const fs::path& path) {
  // Without O_CLOEXEC: runs hold it, too.
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT, 0600);
  if (file_ < 0) fail_at(path);
  const auto end = std::chrono::steady_clock::now() + lock_patience;
  while (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() > end) {
      ::close(file_);
      throw text::UsageError(
          fmt::format("another program works on this sweep now: it holds {}; wait "
                      "for it, or end it",
                      path.string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

Lock::~Lock() { ::close(file_); }

bool Lock::is_held(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool is_free = ::flock(file, LOCK_SH | LOCK_NB) == 0;
  ::close(file);
  return !is_free;
}

}  // namespace ziggurat::sweep
