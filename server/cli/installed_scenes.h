// SPDX-License-Identifier: MIT
#pragma once
// Scenes that come with the program, by name: share/ziggurat/scenes beside its folder.

#include <string>
#include <vector>

namespace ziggurat::cli {

struct InstalledScene {
  std::string name;      ///< its path below the folder of scenes, without .argos
  std::string path;      ///< absolute
  std::string sentence;  ///< the first one of the comment at its beginning; empty: there is none
};

/// All of them by name, without models. A file with a second, shorter name (a symbolic link) has
/// only that one. Empty: nothing is installed.
std::vector<InstalledScene> installed_scenes();

/// The path of a scene that a command line names: the word itself if there is such a file,
/// otherwise the installed scene of that name.
/// @throws text::UsageError if there is neither, and the word is a name without folder and ending
std::string scene_path(const std::string& word);

/// First sentence of the comment at a scene's beginning, on one line.
std::string first_sentence(const std::string& scene);

}  // namespace ziggurat::cli
