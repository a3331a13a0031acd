#include "processes/required_scripts.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <system_error>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 1000;
constexpr std::size_t largest_file = std::size_t{4} << 20;  // [bytes]

/// As Lua looks for a module with dots in its name.
std::string path_of_module(std::string name) {
  std::ranges::replace(name, '.', '/');
  return name + ".lua";
}

std::vector<std::string> loaded_by(const fs::path& script) {
  std::error_code error;
  if (fs::file_size(script, error) > largest_file || error) return {};
  std::ifstream file(script, std::ios::binary);
  std::vector<std::string> names;
  static const std::regex call(R"((require|dofile|loadfile)\s*\(?\s*(?:\w+\s*\.\.\s*)?["']([^"'\n]{1,255})["'])");
  for (std::string line; std::getline(file, line);) {
    if (line.size() > 4096) continue;  // std::regex recurses
    for (std::sregex_iterator at(line.begin(), line.end(), call), end; at != end; ++at) {
      names.push_back((*at)[1] == "require" ? path_of_module((*at)[2]) : (*at)[2].str());
    }
  }
  return names;
}

}  // namespace

void add_required(std::vector<fs::path>& scripts) {
  std::vector<fs::path> folders;
  for (const fs::path& script : scripts) {
    if (std::ranges::find(folders, script.parent_path()) == folders.end()) {
      folders.push_back(script.parent_path());
    }
  }
  std::ranges::sort(scripts);
  scripts.erase(std::unique(scripts.begin(), scripts.end()), scripts.end());
  for (std::size_t i = 0; i < scripts.size() && scripts.size() < most_files; ++i) {
    for (const std::string& name : loaded_by(scripts[i])) {
      std::vector<fs::path> places = folders;
      places.push_back(scripts[i].parent_path());
      for (const fs::path& folder : places) {
        const fs::path path = (folder / name).lexically_normal();
        std::error_code error;
        if (!fs::is_regular_file(path, error)) continue;
        if (fs::file_size(path, error) > largest_file || error) continue;
        if (std::ranges::find(scripts, path) == scripts.end()) scripts.push_back(path);
        break;
      }
    }
  }
}

}  // namespace ziggurat::processes
