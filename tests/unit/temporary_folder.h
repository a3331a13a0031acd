// SPDX-License-Identifier: MIT
#pragma once
// A folder of a test's own, which is removed with it.

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace ziggurat {

struct TemporaryFolder {
  /// Makes the folder, with mode 0700, in the system's folder for temporary files.
  /// @throws std::system_error if it takes none
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ziggurat-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), name);
    }
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path / name; }

  std::filesystem::path path;
};

}  // namespace ziggurat
