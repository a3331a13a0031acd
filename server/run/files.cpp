#include "run/files.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "processes/scripts.h"
#include "scene/files.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;

struct File {
  std::string option;
  std::string path;
  std::vector<std::string> endings;  ///< allowed; empty = all
};

std::vector<File> outputs_of(const Options& options) {
  std::vector<File> files{{"--trace", options.trace, {".csv"}},
                          {"--readings", options.readings, {".jsonl"}},
                          {"--rays", options.rays, {".jsonl"}},
                          {"--hash-file", options.hash_file, {}},
                          {"--record", options.record, {".mcap"}},
                          {"--summary", options.summary, {".json"}},
                          {"--report-card", options.report_card, {".json", ".svg", ".csv"}}};
  if (options.pictures) files.push_back({"--out", options.pictures->out, {".png"}});
  if (options.pictures && options.pictures->film) {
    files.push_back({"--video", options.pictures->film->path, {}});
  }
  std::erase_if(files, [](const File& file) { return file.path.empty(); });
  return files;
}

std::vector<File> inputs_of(const Options& options) {
  std::vector<File> files;
  for (const std::string& scene : options.scenes) files.push_back({"the scene", scene, {}});
  if (!options.curve_secret.empty()) {
    files.push_back({"--curve-secret", options.curve_secret, {}});
    files.push_back({"--curve-clients", options.curve_clients, {}});
  }
  return files;
}

/// Names without ending are fine: a pipe, or /dev/stdout.
void check_ending(const File& file) {
  const std::string ending = fs::path(file.path).extension().string();
  if (ending.empty() || file.endings.empty()) return;
  for (const std::string& each : file.endings) {
    if (ending == each) return;
  }
  throw text::UsageError(
      fmt::format("{} is '{}'; its name must end with {}, because that is the "
                  "format of its content",
                  file.option, file.path, fmt::join(file.endings, " or ")));
}

/// Whether both paths are one file. What several may write to at once, a device or a pipe, is not.
bool is_same(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path whole = fs::weakly_canonical(fs::absolute(a), error);
  return !error && whole == fs::weakly_canonical(fs::absolute(b), error) && !error;
}

/// Who can write the folder of a file can put another file in its place, unless the folder is sticky.
void check_folders(const fs::path& file) {
  std::error_code error;
  fs::path folder = fs::canonical(file, error);
  std::vector<fs::path> folders{fs::absolute(file, error).parent_path()};  // where a link may be
  while (folder.has_relative_path()) folders.push_back(folder = folder.parent_path());
  for (const fs::path& each : folders) {
    struct stat status {};
    const bool is_open = ::stat(each.c_str(), &status) == 0 && (status.st_mode & S_IWOTH) != 0;
    if (!is_open || (status.st_mode & S_ISVTX) != 0) continue;
    throw text::UsageError(fmt::format("--curve-clients is '{}', but all users can write the folder '{}': they could replace the "
                                       "file; write: chmod o-w '{}'",
                                       file.string(), each.string(), each.string()));
  }
}

void check_clients(const std::string& path) {
  struct stat status {};
  if (path.empty() || scene::fault_of_file(path) || ::stat(path.c_str(), &status) != 0) return;  // reported when it is read
  if (const uid_t user = ::geteuid(); user != 0 && status.st_uid != user && status.st_uid != 0) {
    throw text::UsageError(fmt::format("--curve-clients is '{}', which belongs to another user, who could add keys; copy it", path));
  }
  check_folders(path);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  throw text::UsageError(fmt::format(
      "--curve-clients is '{}', which other users can write: they could add their keys; "
      "write: chmod go-w '{}'",
      path, path));
}

}  // namespace

void check_files(const Options& options) {
  const std::vector<File> outputs = outputs_of(options);
  std::vector<File> taken = inputs_of(options);
  for (const File& output : outputs) {
    check_ending(output);
    for (const File& other : taken) {
      if (!is_same(output.path, other.path)) continue;
      throw text::UsageError(fmt::format("{} is '{}', the file of {} too; name another file",
                                         output.option, output.path, other.option));
    }
    taken.push_back(output);
  }
  check_clients(options.curve_clients);
}

void check_outputs(const Options& options, const scene::Scene& scene,
                   const std::vector<std::string>& read) {
  const std::string& scene_file = only_scene(options);
  std::vector<std::string> inputs = scene.files;
  inputs.insert(inputs.end(), read.begin(), read.end());
  for (const fs::path& script : processes::scripts_of(scene, scene_file)) {
    inputs.push_back(script.string());
  }
  for (const File& output : outputs_of(options)) {
    for (const std::string& input : inputs) {
      if (!is_same(output.path, input)) continue;
      throw text::UsageError(
          fmt::format("{} is '{}', a file of the scene, which includes it or runs it as a script; "
                      "name another file",
                      output.option, output.path));
    }
  }
}

}  // namespace ziggurat::run
