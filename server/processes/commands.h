// SPDX-License-Identifier: MIT
#pragma once
// The commands of a scene's controllers: their programs are looked for where its scripts are.

#include <filesystem>
#include <string>
#include <vector>

#include "scene/problem.h"
#include "scene/scene.h"

namespace ziggurat::processes {

struct FoundCommand {
  std::string text;     ///< for /bin/sh: with the path of the file that was found
  std::string missing;  ///< a sentence on the file that is not there; empty if all are
};

/// Value of ZIGGURAT_SCENE_FOLDER for programs of a scene.
std::string scene_folder(const std::filesystem::path& scene_file);

/// Finds the program that a command starts at last, if its name has a slash, and the script that is
/// its first argument
/// (`python3 drive.py`, `nice /usr/bin/python3 'my drive.py'`). Words that only a shell can read
/// are left to it.
FoundCommand find_command(const std::string& command, const std::filesystem::path& naming_file,
                          const std::filesystem::path& scene_file);

/// Puts the files that were found into the commands of a scene's controllers.
/// @returns a warning for each that is not there
std::vector<scene::Problem> find_commands(scene::Scene& scene,
                                          const std::filesystem::path& scene_file);

/// Why /bin/sh can't start the program of a command in the working directory: a sentence. Empty if
/// it can, or if only a shell can read its first word.
std::string why_not_started(const std::string& command);

}  // namespace ziggurat::processes
