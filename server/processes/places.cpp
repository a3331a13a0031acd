// SPDX-License-Identifier: MIT
#include "processes/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "scene/names.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_compared = 256;  // files of a folder

fs::path folder_of(const fs::path& file) {
  return fs::absolute(file).lexically_normal().parent_path();
}

}  // namespace

std::vector<fs::path> places_of(const fs::path& naming_file, const fs::path& scene_file) {
  std::vector<fs::path> places;
  const auto add = [&](const fs::path& folder) {
    if (std::ranges::find(places, folder) == places.end()) places.push_back(folder);
  };
  add(folder_of(naming_file));
  for (fs::path folder = folder_of(scene_file);; folder = folder.parent_path()) {
    add(folder);
    if (folder == folder.parent_path()) break;
  }
  std::error_code error;
  if (const fs::path here = fs::current_path(error); !error) add(here);
  return places;
}

std::optional<fs::path> find_file(const std::string& name, const fs::path& naming_file,
                                  const fs::path& scene_file) {
  std::error_code error;
  const fs::path path(name);
  for (const fs::path& place : places_of(naming_file, scene_file)) {
    const fs::path file = (place / path).lexically_normal();  // an absolute path stays what it is
    if (fs::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

std::string similar_file(const fs::path& missing) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(missing.parent_path(), error), end; !error && file != end;
       file.increment(error)) {
    if (names.size() >= most_compared) break;
    if (file->is_regular_file(error)) names.push_back(file->path().filename().string());
  }
  std::ranges::sort(names);
  const std::vector<std::string_view> views(names.begin(), names.end());
  const auto meant = scene::nearest(missing.filename().string(), views);
  return meant ? std::string(*meant) : std::string();
}

std::string looked_for(const std::string& name, const fs::path& naming_file,
                       const fs::path& scene_file) {
  if (fs::path(name).is_absolute()) return "; check its path";
  const fs::path beside = folder_of(naming_file), of_scene = folder_of(scene_file);
  std::error_code error;
  if (fs::exists(beside / name, error)) {
    return fmt::format(": in {} it is not a regular file", beside.string());
  }
  const fs::path here = fs::current_path(error);
  std::string text = fmt::format(" in {}", beside.string());
  if (beside != of_scene) text += fmt::format(", nor in {}", of_scene.string());
  text += ", nor in the folders above";
  if (!error && here != beside && here != of_scene) {
    text += fmt::format(", nor in the working directory {}", here.string());
  }
  const std::string meant = similar_file(beside / name);
  return meant.empty() ? text + "; put it beside the scene"
                       : text + fmt::format("; did you mean '{}'?",
                                            (fs::path(name).parent_path() / meant).string());
}

}  // namespace ziggurat::processes
