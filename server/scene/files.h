// SPDX-License-Identifier: MIT
#pragma once
// The files that a scene is read from.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>

namespace ziggurat::scene {

struct File {
  std::string identity;  ///< the same for every path that leads to this file
  std::string text;
};

/// Whether a path can't lead out of the folder that it is relative to.
bool stays_inside(const std::filesystem::path& path);

/// Opens a file of at most `max_size` bytes. If that fails: why, as `does not exist; …`.
using OpenFile = std::function<std::variant<File, std::string>(const std::filesystem::path&,
                                                               std::size_t max_size)>;

/// Why nothing can be read from a path that a person gave, as `does not exist; …`; none if there is
/// a regular file. To open a pipe would wait for its writer, and a device may have no end.
std::optional<std::string> fault_of_file(const std::filesystem::path& path);

/// From disk, regular files only.
std::variant<File, std::string> open_file(const std::filesystem::path& path, std::size_t max_size);

/// For elements that are added to a scene: no file may be read.
std::variant<File, std::string> open_no_file(const std::filesystem::path& path,
                                             std::size_t max_size);

}  // namespace ziggurat::scene
