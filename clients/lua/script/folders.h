// SPDX-License-Identifier: MIT
#pragma once
// The folders whose files a script may use.

#include <filesystem>
#include <string>
#include <vector>

namespace ziggurat::lua {

/// Files in the folders that scripts may use less, by whatever name and link.
struct Exceptions {
  std::vector<std::filesystem::path> read_only;  ///< they may read these, and not change them
  std::vector<std::filesystem::path> hidden;     ///< they may not use these
};

class Folders {
 public:
  /// Everything below these but the exceptions.
  /// @throws std::runtime_error that names the one which is no folder
  explicit Folders(const std::vector<std::filesystem::path>& folders, Exceptions exceptions = {});

  /// Whether a file is below a folder when all symbolic links are resolved, and neither it nor a
  /// folder between is hidden (its name begins with a dot, or it is an exception). The file need
  /// not exist.
  bool contain(const std::filesystem::path& file) const;

  bool is_read_only(const std::filesystem::path& file) const;

  /// For messages: "'/a', '/b'".
  std::string names() const;

 private:
  std::vector<std::filesystem::path> folders_;  // canonical
  Exceptions exceptions_;
};

}  // namespace ziggurat::lua
