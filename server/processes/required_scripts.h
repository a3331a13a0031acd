#pragma once
// The Lua files that scripts load.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ziggurat::processes {

/// Appends the files that the scripts name in `require`, `dofile` and `loadfile` as plain texts, and
/// those that these name, as far as they are found in the folder of a script. Of names that are put
/// together, as in `require(here .. "tool")`, the end is looked for beside the script. If a script
/// computes a name in another way, as in `require(name)`, the Lua files of its folder are appended; those
/// of a folder below it if names begin with that, as in `require("parts." .. kind)`. 1000 files are the
/// most, each of 4 MiB, and 16 MiB of those whose names are computed.
/// @return  folders with files that did not fit
std::vector<std::filesystem::path> add_required(std::vector<std::filesystem::path>& scripts);

/// A module that is required and is not there.
struct MissingModule {
  std::filesystem::path script;  ///< that requires it
  std::size_t line = 0;
  std::string name;
};

/// Those that a script, or one that it requires, names in `require` as a plain text and that Lua finds nowhere.
/// What is required in a call of pcall may be missing.
std::vector<MissingModule> missing_modules(const std::filesystem::path& script);

}  // namespace ziggurat::processes
