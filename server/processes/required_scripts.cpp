// SPDX-License-Identifier: MIT
#include "processes/required_scripts.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <lua.hpp>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <system_error>

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

using Paths = std::vector<fs::path>;

constexpr std::size_t most_files = 1000;
constexpr std::size_t largest_file = std::size_t{4} << 20;  // [bytes]
constexpr std::size_t most_listed = std::size_t{16}
                                    << 20;  // of all listed folders together [bytes]

/// Modules that a script loads.
struct Loaded {
  std::vector<std::string> names;
  std::vector<std::string>
      folders;  ///< whose files have names that it computes; empty: its own folder
};

bool has(const Paths& all, const fs::path& path) {
  return std::ranges::find(all, path) != all.end();
}

/// As Lua looks for a module with dots in its name.
std::string path_of_module(std::string name) {
  std::ranges::replace(name, '.', '/');
  return name + ".lua";
}

/// The folder below a script's own that all names have that begin so; empty: there is none.
std::string folder_of_names(std::string begin, bool are_modules) {
  if (are_modules) std::ranges::replace(begin, '.', '/');
  const fs::path folder = fs::path(begin).parent_path();
  const bool leaves =
      folder.is_absolute() || std::ranges::find(folder, fs::path("..")) != folder.end();
  return leaves ? std::string() : folder.string();
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
      const bool is_module = (*at)[1] == "require";
      if (!name.empty()) loaded.names.push_back(is_module ? path_of_module(name) : name);
      const bool is_whole = !name.empty() && !(*at)[4].matched;
      if (is_whole || ((*at)[2].length() == 0 && name.empty())) continue;
      loaded.folders.push_back(folder_of_names(name, is_module));
    }
  }
  return loaded;
}

/// The Lua files of a folder, in the order of their names.
Paths scripts_in(const fs::path& folder) {
  Paths scripts;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    std::error_code other;
    if (at->path().extension() != ".lua" || !at->is_regular_file(other)) continue;
    scripts.push_back(folder / at->path().filename());
  }
  std::ranges::sort(scripts);
  return scripts;
}

/// Lua's own search for modules, as a script in a folder has it.
class Modules {
 public:
  explicit Modules(const fs::path& folder) : lua_(luaL_newstate(), lua_close) {
    luaL_openlibs(lua_.get());
    const std::string own = folder.empty() ? "." : folder.string();
    lua_getglobal(lua_.get(), "package");
    lua_getfield(lua_.get(), 1, "path");
    lua_pushfstring(lua_.get(), "%s/?.lua;%s/?/init.lua;%s", own.c_str(), own.c_str(),
                    lua_tostring(lua_.get(), -1));
    lua_setfield(lua_.get(), 1, "path");
  }

  /// The file of a module; empty: it is one of Lua's own; nothing: it is not there.
  std::optional<fs::path> find(const std::string& name) {
    lua_State* const lua = lua_.get();
    lua_settop(lua, 1);
    lua_getfield(lua, 1, "loaded");
    if (lua_getfield(lua, -1, name.c_str()) != LUA_TNIL) return fs::path();
    for (const char* path : {"path", "cpath"}) {
      lua_getfield(lua, 1, "searchpath");
      lua_pushstring(lua, name.c_str());
      lua_getfield(lua, 1, path);
      const bool is_found = lua_pcall(lua, 2, 1, 0) == LUA_OK && lua_type(lua, -1) == LUA_TSTRING;
      if (is_found) return fs::path(lua_tostring(lua, -1));
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<lua_State, decltype(&lua_close)> lua_;
};

/// Appends what a script requires and is not there, and to `scripts` what is.
void look_for_modules(const fs::path& script, Modules& modules, Paths& scripts,
                      std::vector<MissingModule>& missing) {
  if (!size_of(script)) return;
  static const std::regex call(R"(\brequire\s*\(?\s*["']([^"'\n]{1,255})["']\s*(\.\.)?)");
  std::ifstream file(script, std::ios::binary);
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.size() > 4096) continue;  // std::regex recurses
    const auto comment = static_cast<std::ptrdiff_t>(std::min(line.find("--"), line.size()));
    for (std::sregex_iterator at(line.begin(), line.begin() + comment, call), end; at != end;
         ++at) {
      if ((*at)[2].matched) continue;  // the name goes on
      const auto found = modules.find((*at)[1]);
      if (!found) {
        missing.push_back({script, number, (*at)[1]});
      } else if (found->extension() == ".lua" && !has(scripts, *found)) {
        scripts.push_back(*found);
      }
    }
  }
}

struct Search {
  Paths& scripts;
  Paths folders;  ///< of the first scripts
  Paths listed, left_out;
  std::size_t listed_size = 0;  ///< [bytes]
};

void leave_out(Search& search, const fs::path& path) {
  if (!has(search.left_out, path.parent_path())) search.left_out.push_back(path.parent_path());
}

void add(Search& search, const fs::path& path) {
  if (has(search.scripts, path)) return;
  search.scripts.size() < most_files ? search.scripts.push_back(path) : leave_out(search, path);
}

/// All Lua files of a folder, as far as they fit.
void add_all(Search& search, const fs::path& folder) {
  if (has(search.listed, folder)) return;
  search.listed.push_back(folder);
  for (const fs::path& path : scripts_in(folder)) {
    if (has(search.scripts, path)) continue;
    const auto size = size_of(path);
    if (!size || search.listed_size + *size > most_listed || search.scripts.size() >= most_files) {
      leave_out(search, path);
      continue;
    }
    search.listed_size += *size;
    search.scripts.push_back(path);
  }
}

/// Files that a script in the folder `own` loads.
void follow(Search& search, const fs::path& own, const Loaded& loaded) {
  Paths places = search.folders;
  places.push_back(own);
  for (const std::string& name : loaded.names) {
    for (const fs::path& place : places) {
      const fs::path path = (place / name).lexically_normal();
      if (!size_of(path)) continue;
      add(search, path);
      break;
    }
  }
  for (const std::string& name : loaded.folders) {
    bool is_found = false;
    for (const fs::path& place : places) {
      std::error_code error;
      const fs::path folder = (place / name).lexically_normal();
      if (name.empty() || !fs::is_directory(folder, error)) continue;
      add_all(search, folder);
      is_found = true;
    }
    if (!is_found) add_all(search, own);
  }
}

}  // namespace

std::vector<MissingModule> missing_modules(const fs::path& script) {
  Modules modules(script.parent_path());
  std::vector<MissingModule> missing;
  Paths scripts{script};
  for (std::size_t i = 0; i < std::min(scripts.size(), most_files); ++i) {
    look_for_modules(fs::path(scripts[i]), modules, scripts, missing);
  }
  return missing;
}

Paths add_required(Paths& scripts) {
  Search search{scripts, {}, {}, {}};
  for (const fs::path& script : scripts) {
    if (!has(search.folders, script.parent_path())) search.folders.push_back(script.parent_path());
  }
  std::ranges::sort(scripts);
  scripts.erase(std::unique(scripts.begin(), scripts.end()), scripts.end());
  for (std::size_t i = 0; i < scripts.size() && scripts.size() < most_files; ++i) {
    const fs::path script = scripts[i];
    follow(search, script.parent_path(), loaded_by(script));
  }
  return search.left_out;
}

}  // namespace ziggurat::processes
