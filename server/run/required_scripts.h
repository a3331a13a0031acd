#pragma once
// The Lua files that scripts load.

#include <filesystem>
#include <vector>

namespace ziggurat::run {

/// Appends the files that the scripts name in `require`, `dofile` and `loadfile` as plain texts, and
/// those that these name, as far as they are found in the folder of a script. Names that are put
/// together when the script runs are not found.
void add_required(std::vector<std::filesystem::path>& scripts);

}  // namespace ziggurat::run
