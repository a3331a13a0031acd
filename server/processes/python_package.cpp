// SPDX-License-Identifier: MIT
#include "processes/python_package.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

bool has_client(const fs::path& package) {
  std::error_code error;
  return fs::is_regular_file(package / "protocol_pb2.py", error) &&
         fs::is_regular_file(package / "__init__.py", error);
}

/// Folder of a build, build/release/python, or of an installation, lib/python3.N/dist-packages or
/// site-packages.
std::vector<fs::path> places_below(const fs::path& prefix) {
  std::vector<fs::path> places{prefix / "python/ziggurat"};
  std::error_code error;
  for (fs::directory_iterator it(prefix / "lib", error), end; !error && it != end;
       it.increment(error)) {
    if (!it->path().filename().string().starts_with("python3")) continue;
    places.push_back(it->path() / "dist-packages/ziggurat");
    places.push_back(it->path() / "site-packages/ziggurat");
  }
  std::ranges::sort(places.begin() + 1, places.end());
  return places;
}

}  // namespace

std::string python_path(const std::string& folder) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto places = places_below(program.parent_path().parent_path());
  const auto package = std::ranges::find_if(places, has_client);
  if (error || package == places.end()) return {};
  const fs::path alone = fs::path(folder) / "python";
  fs::create_directory(alone, error);
  if (!error) fs::create_directory_symlink(*package, alone / "ziggurat", error);
  if (error) return {};
  const char* const others = std::getenv("PYTHONPATH");
  return others == nullptr || *others == '\0' ? alone.string() : alone.string() + ":" + others;
}

}  // namespace ziggurat::processes
