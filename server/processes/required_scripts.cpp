#include "processes/required_scripts.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <string>
#include <system_error>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 1000;
constexpr std::size_t largest_file = std::size_t{4} << 20;  // [bytes]
constexpr std::size_t most_listed = std::size_t{16} << 20;  // of a folder's files together [bytes]

/// What a script loads.
struct Loaded {
  std::vector<std::string> names;
  bool computes_names = false;
};

/// As Lua looks for a module with dots in its name.
std::string path_of_module(std::string name) {
  std::ranges::replace(name, '.', '/');
  return name + ".lua";
}

/// The size of a file that may be embedded; nothing: it may not, or there is none.
std::optional<std::size_t> size_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const auto size = fs::file_size(path, error);
  if (error || size > largest_file) return std::nullopt;
  return static_cast<std::size_t>(size);
}

Loaded loaded_by(const fs::path& script) {
  Loaded loaded;
  if (!size_of(script)) return loaded;
  std::ifstream file(script, std::ios::binary);
  // A load with or without a plain name at the end of the first two parts of what is given to it.
  static const std::regex call(R"(\b(require|dofile|loadfile)\b\s*([(,]?)\s*)"
                               R"((?:(?:\w+\s*\.\.\s*)?["']([^"'\n]{1,255})["']\s*(\.\.)?)?)");
  for (std::string line; std::getline(file, line);) {
    if (line.size() > 4096) continue;  // std::regex recurses
    for (std::sregex_iterator at(line.begin(), line.end(), call), end; at != end; ++at) {
      const std::string name = (*at)[3];
      if (!name.empty()) loaded.names.push_back((*at)[1] == "require" ? path_of_module(name) : name);
      const bool is_whole = !name.empty() && !(*at)[4].matched;
      if (!is_whole && ((*at)[2].length() > 0 || !name.empty())) loaded.computes_names = true;
    }
  }
  return loaded;
}

/// The Lua files of a folder, in the order of their names; none if they are too large together.
std::vector<fs::path> scripts_in(const fs::path& folder) {
  std::vector<fs::path> scripts;
  std::size_t size = 0;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end; at.increment(error)) {
    const auto own = at->path().extension() == ".lua" ? size_of(at->path()) : std::nullopt;
    if (!own) continue;
    size += *own;
    scripts.push_back(folder / at->path().filename());
    if (scripts.size() > most_files || size > most_listed) return {};
  }
  std::ranges::sort(scripts);
  return scripts;
}

}  // namespace

void add_required(std::vector<fs::path>& scripts) {
  std::vector<fs::path> folders, listed;
  const auto has = [](const std::vector<fs::path>& all, const fs::path& path) {
    return std::ranges::find(all, path) != all.end();
  };
  const auto add = [&](const fs::path& path) {
    if (!has(scripts, path) && scripts.size() < most_files) scripts.push_back(path);
  };
  for (const fs::path& script : scripts) {
    if (!has(folders, script.parent_path())) folders.push_back(script.parent_path());
  }
  std::ranges::sort(scripts);
  scripts.erase(std::unique(scripts.begin(), scripts.end()), scripts.end());
  for (std::size_t i = 0; i < scripts.size() && scripts.size() < most_files; ++i) {
    const fs::path own = scripts[i].parent_path();
    const Loaded loaded = loaded_by(scripts[i]);
    for (const std::string& name : loaded.names) {
      std::vector<fs::path> places = folders;
      places.push_back(own);
      for (const fs::path& folder : places) {
        const fs::path path = (folder / name).lexically_normal();
        if (!size_of(path)) continue;
        add(path);
        break;
      }
    }
    if (!loaded.computes_names || has(listed, own)) continue;
    listed.push_back(own);
    for (const fs::path& path : scripts_in(own)) add(path);
  }
}

}  // namespace ziggurat::processes
