#pragma once
// The folders whose files a script may use.

#include <filesystem>
#include <string>
#include <vector>

namespace ziggurat::lua {

class Folders {
 public:
  /// Everything below these.
  /// @throws std::runtime_error that names the one which is no folder
  explicit Folders(const std::vector<std::filesystem::path>& folders);

  /// Whether a file is below a folder when all symbolic links are resolved, and neither it nor a
  /// folder between is hidden (its name begins with a dot). The file need not exist.
  bool contain(const std::filesystem::path& file) const;

  /// For messages: "'/a', '/b'".
  std::string names() const;

 private:
  std::vector<std::filesystem::path> folders_;  // canonical
};

}  // namespace ziggurat::lua
