#include "run/clients_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "scene/files.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;

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

/// Patterns that match none of the names.
std::vector<std::string> without_effect(const std::vector<std::string>& patterns, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& pattern : patterns) {
    const network::Glob glob(pattern);
    const auto means = [&](const std::string& name) { return name == pattern || glob.matches(name); };
    if (std::ranges::none_of(names, means)) found.push_back(pattern);
  }
  return found;
}

}  // namespace

std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients, const scene::Scene& scene,
                                   const world::Layout& layout) {
  std::vector<std::string> robots, controllers, doubts;
  for (const auto& robot : layout.robots) robots.push_back(robot.id);
  for (const auto& controller : scene.controllers) controllers.push_back(controller.id);
  for (const network::ClientKey& client : clients) {
    const auto doubt = [&](const char* limit, const char* what, const std::vector<std::string>& patterns) {
      if (patterns.empty()) return;
      doubts.push_back(fmt::format("--curve-clients: {}={} of the key {} means no {} of the scene", limit,
                                   fmt::join(patterns, ","), client.name.empty() ? client.public_key : client.name, what));
    };
    doubt("robots", "robot", without_effect(client.scope.robots, robots));
    doubt("controllers", "controller", without_effect(client.scope.controllers, controllers));
  }
  return doubts;
}

void check_clients(const std::string& path, uid_t user) {
  struct stat status {};
  if (path.empty() || scene::fault_of_file(path) || ::stat(path.c_str(), &status) != 0) return;  // reported when it is read
  if (user != 0 && status.st_uid != user && status.st_uid != 0) {
    throw text::UsageError(fmt::format("--curve-clients is '{}', which belongs to another user, who could add keys; copy it", path));
  }
  check_folders(path);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  throw text::UsageError(fmt::format(
      "--curve-clients is '{}', which other users can write: they could add their keys; "
      "write: chmod go-w '{}'",
      path, path));
}

}  // namespace ziggurat::run
