// SPDX-License-Identifier: MIT
#include "gallery/pictures.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "math/hash.h"

namespace ziggurat::gallery {

namespace fs = std::filesystem;

fs::path cache_folder() {
  const auto given = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value == nullptr ? "" : value);
  };
  fs::path base = given("XDG_CACHE_HOME");
  if (!base.is_absolute() && given("HOME").is_absolute()) base = given("HOME") / ".cache";
  if (!base.is_absolute()) base = fs::temp_directory_path();
  return base / "ziggurat/gallery";
}

fs::path picture_file(const fs::path& cache, const fs::path& scene) {
  std::ifstream file(scene, std::ios::binary);
  std::string content(std::size_t{1} << 20, '\0');
  file.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(file.gcount()));
  math::Hash hash;
  hash.add(std::string_view(fs::absolute(scene).lexically_normal().native()));
  hash.add(std::string_view(content));
  return cache / (math::to_hex(hash.digest()) + ".png");
}

void forget_old(const fs::path& cache, std::size_t most) {
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, fs::path>> pictures;
  for (const auto& entry : fs::directory_iterator(cache, error)) {
    if (entry.path().extension() != ".png") continue;
    const auto time = entry.last_write_time(error);
    if (!error) pictures.emplace_back(time, entry.path());
  }
  if (pictures.size() <= most) return;
  std::ranges::sort(pictures);
  for (std::size_t i = 0; i < pictures.size() - most; ++i) fs::remove(pictures[i].second, error);
}

}  // namespace ziggurat::gallery
