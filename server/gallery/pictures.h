// SPDX-License-Identifier: MIT
#pragma once
// The pictures of scenes, in a folder of the user's cache.

#include <filesystem>
#include <string>

namespace ziggurat::gallery {

/// `ziggurat/gallery` in XDG_CACHE_HOME, otherwise in ~/.cache, otherwise in a folder for temporary
/// files.
std::filesystem::path cache_folder();

/// Path of the picture of a scene. Another content of the file is another picture.
std::filesystem::path picture_file(const std::filesystem::path& cache,
                                   const std::filesystem::path& scene);

/// Removes the oldest pictures beyond a number. Errors have no effect.
void forget_old(const std::filesystem::path& cache, std::size_t most);

}  // namespace ziggurat::gallery
