// SPDX-License-Identifier: MIT
#pragma once
// Files that a run reads and writes. Those that options name are checked before any of them is
// opened, because opening an output empties it.

#include <string>
#include <vector>

#include "outputs/output_name.h"
#include "run/options.h"
#include "scene/scene.h"

namespace ziggurat::run {

/// @throws text::UsageError if check_output() refuses an output, or it is the scene, a key file or
/// another output; if all users can write the list of clients' keys
void check_files(const Options& options);

/// The scene's file, what it includes, and its scripts.
std::vector<std::string> files_of(const scene::Scene& scene, const std::string& path);

/// Files of a scene, its includes and its scripts, which no output may replace.
std::vector<outputs::TakenFile> taken_by_scene(const std::vector<std::string>& files);

/// Checks that no output is a file that the scene was read from, or one of its scripts.
/// @param read  other files that were read for the scene
/// @throws text::UsageError
void check_outputs(const Options& options, const scene::Scene& scene,
                   const std::vector<std::string>& read = {});

/// Arguments of ziggurat-lua that protect files in the scene's folder, which scripts may use.
/// Scripts can't change the scene, its includes and scripts, outputs, and the list of keys. They
/// can't read the secret key.
/// @param fixed  files that they can't change either
std::vector<std::string> exceptions_of(const Options& options,
                                       const std::vector<std::string>& fixed);

/// Folder of files that come with the program: share/ziggurat/NAME beside its folder, in a build or
/// below a prefix. "web", the page's, is missing if the page was not built.
std::string shared_folder(const char* name);

}  // namespace ziggurat::run
