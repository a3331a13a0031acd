// SPDX-License-Identifier: MIT
#pragma once
// A folder that only this user can enter, for the socket and the files of one run.

#include <string>

#include "processes/guardian.h"

namespace ziggurat::processes {

class PrivateFolder {
 public:
  /// Makes it in XDG_RUNTIME_DIR, otherwise in /tmp, with a path short enough for a socket in it.
  /// Removes there what programs of this user left behind that could not clean up: each holds a
  /// lock on its folder as long as it runs.
  /// @param guardian  removes it if this program is killed; null: none
  /// @throws std::system_error
  explicit PrivateFolder(const Guardian* guardian = nullptr);
  /// Removes it with everything in it.
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int lock_ = -1;  ///< of the file `lock` in it
};

/// Removal of a folder that holds a lock: at each moment it has its lock, or nothing else.
inline constexpr const char* lock_name = "lock";

/// Removes a folder with everything in it, at last its lock and itself. It stays if something can't
/// be removed.
void remove_locked_folder(const std::string& folder) noexcept;

}  // namespace ziggurat::processes
