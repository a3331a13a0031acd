// SPDX-License-Identifier: MIT
#pragma once
// The scenes of a folder: what a reader is told of each.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat::gallery {

struct Scene {
  std::filesystem::path file;  ///< as the folder was named
  std::string name;            ///< below the folder, without `.argos`
  std::string sentence;        ///< first one of the comment at the top; empty: there is none
};

constexpr std::size_t most_scenes = 500;

/// Files `.argos` with a scene, by name; below the folder, up to four levels deep. Files of models,
/// hidden ones and symbolic links are left out, and so are those beyond most_scenes.
/// @throws std::filesystem::filesystem_error if the folder can't be read
std::vector<Scene> scenes_below(const std::filesystem::path& folder);

/// First sentence of the first comment, in one line, with 300 bytes at most. Empty: there is none.
/// @param xml  the beginning of a file
std::string first_sentence(std::string_view xml);

}  // namespace ziggurat::gallery
