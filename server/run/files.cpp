#include "run/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "processes/scripts.h"
#include "run/clients_file.h"
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

/// What it includes, and its scripts.
std::vector<std::string> files_of(const scene::Scene& scene, const std::string& path) {
  std::vector<std::string> files = scene.files;
  for (const fs::path& script : processes::scripts_of(scene, path)) files.push_back(script.string());
  return files;
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
  check_clients(options.curve_clients, ::geteuid());
}

void check_outputs(const Options& options, const scene::Scene& scene,
                   const std::vector<std::string>& read) {
  std::vector<std::string> inputs = files_of(scene, only_scene(options));
  inputs.insert(inputs.end(), read.begin(), read.end());
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

std::vector<std::string> exceptions_of(const Options& options, const scene::Scene* scene, const std::string& path) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& file) {
    if (!file.empty()) arguments.insert(arguments.end(), {option, fs::absolute(file).string()});
  };
  if (scene) {
    for (const std::string& file : files_of(*scene, path)) add("--read-only-file", file);
  }
  for (const File& output : outputs_of(options)) add("--read-only-file", output.path);
  add("--read-only-file", options.curve_clients);
  add("--hidden-file", options.curve_secret);
  return arguments;
}

}  // namespace ziggurat::run
