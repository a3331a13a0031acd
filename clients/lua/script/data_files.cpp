// SPDX-License-Identifier: MIT
#include "script/data_files.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

// Such texts are instructions for builds and package managers.
constexpr const char* instructions[] = {
    "cmake*.txt",        "meson*.txt",       "conan*.txt",       "requirements*.txt",
    "*requirements.txt", "constraints*.txt", "entry_points.txt", "top_level.txt"};

bool is_of_data(const fs::path& name) {
  std::string ending = name.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string each = " " + std::string(data_endings) + " ";
  return !ending.empty() && each.find(" " + ending + " ") != std::string::npos &&
         std::ranges::none_of(instructions, [&](const char* pattern) {
           return ::fnmatch(pattern, name.c_str(), FNM_CASEFOLD) == 0;
         });
}

}  // namespace

bool is_data_file(const fs::path& file) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(fs::absolute(file, error), error);
  return !error && is_of_data(file.filename()) && is_of_data(target.filename());
}

}  // namespace ziggurat::lua
