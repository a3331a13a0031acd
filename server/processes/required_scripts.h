// SPDX-License-Identifier: MIT
#pragma once
// The Lua files that scripts load.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ziggurat::processes {

/// Appends the files that the scripts name in `require`, `dofile` and `loadfile` as plain texts,
/// and those that these name. Only files in the folder of a script are found. For composed names,
/// as in `require(here .. "tool")`, the end is looked for beside the script. For computed names, as
/// in `require(name)`, the Lua files of its folder are appended. If names begin with a folder below
/// it, as in `require("parts." .. kind)`, they are those of that folder. At most 1000 files of 4
/// MiB each are appended, and 16 MiB of those whose names are computed.
/// @return  folders with files that did not fit
std::vector<std::filesystem::path> add_required(std::vector<std::filesystem::path>& scripts);

/// A module that is required and is not there.
struct MissingModule {
  std::filesystem::path script;  ///< that requires it
  std::size_t line = 0;
  std::string name;
};

/// Modules that a script, or one that it requires, names in `require` as a plain text and that Lua
/// finds nowhere. A module that is required in a call of pcall may be missing.
std::vector<MissingModule> missing_modules(const std::filesystem::path& script);

}  // namespace ziggurat::processes
