// SPDX-License-Identifier: MIT
#include "run/files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "outputs/output_name.h"
#include "processes/scripts.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;
using outputs::OutputName;
using outputs::TakenFile;

std::vector<OutputName> outputs_of(const Options& options) {
  std::vector<OutputName> files{{"--trace", options.trace, {".csv"}},
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
  std::erase_if(files, [](const OutputName& file) { return file.path.empty(); });
  return files;
}

/// Each by the name with its number.
std::vector<OutputName> pictures_of(const Options& options) {
  std::vector<OutputName> files;
  if (!options.pictures || options.pictures->out.empty()) return files;
  const std::size_t count = options.pictures->times.size();
  for (std::size_t i = 0; i < count; ++i) {
    files.push_back({"--out", picture_path(options.pictures->out, i, count), {".png"}});
  }
  return files;
}

/// @throws text::UsageError if all users can write the list of clients' keys
void check_clients(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) ||
      (status.st_mode & S_IWOTH) == 0)
    return;
  throw text::UsageError(
      fmt::format("--curve-clients is '{}', which all users can write: they could add their keys; "
                  "write: chmod o-w '{}'",
                  path, path));
}

TakenFile taken_by(const std::string& what, const std::string& path) {
  return {path, fmt::format("the file of {} too", what)};
}

std::vector<TakenFile> inputs_of(const Options& options) {
  std::vector<TakenFile> files;
  for (const std::string& scene : options.scenes) files.push_back(taken_by("the scene", scene));
  if (!options.curve_secret.empty()) {
    files.push_back(taken_by("--curve-secret", options.curve_secret));
    files.push_back(taken_by("--curve-clients", options.curve_clients));
  }
  return files;
}

}  // namespace

std::vector<std::string> files_of(const scene::Scene& scene, const std::string& path) {
  std::vector<std::string> files = scene.files;
  for (const fs::path& script : processes::scripts_of(scene, path))
    files.push_back(script.string());
  return files;
}

std::vector<TakenFile> taken_by_scene(const std::vector<std::string>& files) {
  std::vector<TakenFile> taken;
  for (const std::string& file : files) {
    taken.push_back({file, "a file of the scene, which includes it or runs it as a script"});
  }
  return taken;
}

void check_files(const Options& options) {
  const std::vector<TakenFile> inputs = inputs_of(options);
  std::vector<TakenFile> taken = inputs;
  for (const OutputName& output : outputs_of(options)) {
    check_output(output, taken);
    taken.push_back(taken_by(output.option, output.path));
  }
  for (const OutputName& picture : pictures_of(options)) check_output(picture, inputs);
  check_clients(options.curve_clients);
}

void check_outputs(const Options& options, const scene::Scene& scene,
                   const std::vector<std::string>& read) {
  std::vector<std::string> inputs = files_of(scene, only_scene(options));
  inputs.insert(inputs.end(), read.begin(), read.end());
  const std::vector<TakenFile> taken = taken_by_scene(inputs);
  for (const OutputName& output : outputs_of(options)) check_output(output, taken);
  for (const OutputName& picture : pictures_of(options)) check_output(picture, taken);
}

std::vector<std::string> exceptions_of(const Options& options,
                                       const std::vector<std::string>& fixed) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& file) {
    if (!file.empty()) arguments.insert(arguments.end(), {option, fs::absolute(file).string()});
  };
  for (const std::string& file : fixed) add("--read-only-file", file);
  for (const OutputName& output : outputs_of(options)) add("--read-only-file", output.path);
  add("--read-only-file", options.curve_clients);
  add("--hidden-file", options.curve_secret);
  return arguments;
}

std::string shared_folder(const char* name) {
  std::error_code error;
  const auto program = fs::read_symlink("/proc/self/exe", error);
  return (program.parent_path().parent_path() / "share/ziggurat" / name).string();
}

}  // namespace ziggurat::run
