// SPDX-License-Identifier: MIT
#pragma once
// Paths of the files that a scene names: scripts, and the programs of commands.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ziggurat::processes {

/// The folders in which a relative path is looked for, in this order: the folder of the file that
/// names it, the folder of the scene file, those above that, the working directory. Absolute, each
/// once.
std::vector<std::filesystem::path> places_of(const std::filesystem::path& naming_file,
                                             const std::filesystem::path& scene_file);

/// The regular file of that name, as an absolute path.
/// @param name  absolute, or relative to the first of the places that has it
std::optional<std::filesystem::path> find_file(const std::string& name,
                                               const std::filesystem::path& naming_file,
                                               const std::filesystem::path& scene_file);

/// The end of a message on a file that is not there: where it was looked for, and a name that was
/// probably meant.
std::string looked_for(const std::string& name, const std::filesystem::path& naming_file,
                       const std::filesystem::path& scene_file);

/// The name of a file beside the one that is not there, with nearly its name; empty if there is
/// none.
std::string similar_file(const std::filesystem::path& missing);

}  // namespace ziggurat::processes
